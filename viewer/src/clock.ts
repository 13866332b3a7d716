// The instant that is shown. Everything that shows it listens.

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

export class Clock {
  readonly begin: number;
  readonly end: number;
  speed = 1;
  private now: number;
  private last: number | undefined;
  private readonly listeners: (() => void)[] = [];

  constructor(begin: number, end: number) {
    this.begin = begin;
    this.end = end;
    this.now = begin;
  }

  get time(): number {
    return this.now;
  }

  get playing(): boolean {
    return this.last !== undefined;
  }

  /** Called when the instant, or whether it plays, has changed. */
  onChange(listener: () => void): void {
    this.listeners.push(listener);
  }

  seek(time: number): void {
    this.now = Math.min(Math.max(time, this.begin), this.end);
    this.tell();
  }

  play(): void {
    if (this.playing) return;
    if (this.now >= this.end) this.now = this.begin;
    this.last = performance.now();
    requestAnimationFrame(this.frame);
    this.tell();
  }

  pause(): void {
    this.last = undefined;
    this.tell();
  }

  toggle(): void {
    if (this.playing) this.pause();
    else this.play();
  }

  private readonly frame = (stamp: number): void => {
    if (this.last === undefined) return;
    this.now += (Math.max(stamp - this.last, 0) / 1e3) * this.speed;
    this.last = Math.max(stamp, this.last);
    if (this.now >= this.end) {
      this.now = this.end;
      this.last = undefined;
    } else requestAnimationFrame(this.frame);
    this.tell();
  };

  private tell(): void {
    for (const listener of this.listeners) listener();
  }
}
