// The runs that the page carries: the JSON in `#prone-runs`, format version 1 (see README.md).

/** What this script reads. */
export const FORMAT_VERSION = 1;

/** Parts of the body whose highest points are recorded, as the columns `<part>_top_mm` call them. */
export const BODY_PARTS = ["head", "trunk", "arms", "legs", "feet"] as const;

/** Groups of the body whose contacts are recorded, as the columns `<group>_n` call them. */
export const CONTACT_GROUPS = ["toe", "elbow", "torso", "leg", "head", "hand"] as const;

export type Vec3 = [number, number, number];
/** Real part first. */
export type Quat = [number, number, number, number];

export interface JointModel {
  name: string;
  axis: Vec3;
  anchor: Vec3;
  range: [number, number];
}

export interface BodyModel {
  name: string;
  parent: number | null;
  position: Vec3;
  quaternion: Quat;
  joint: JointModel | null;
  /** kg; the reader of records does not insist on it. */
  mass?: number;
  /** In the body's own frame, m. */
  centre_of_mass?: Vec3;
}

export interface ShapeModel {
  body: number;
  type: string;
  size: number[];
  position: Vec3;
  quaternion: Quat;
  rgba: [number, number, number, number];
  group: number;
}

export interface Site {
  body: number;
  position: Vec3;
}

export interface SideModel {
  toe: Site;
  ankle: string;
  knee: string;
  hip: string;
  shoulder: string;
  elbow: Site;
}

export interface ObstacleModel {
  name: string;
  kind: string;
  half_edges: Vec3;
  position: Vec3;
  quaternion: Quat;
}

export interface RoughModel {
  from_x: number;
  length: number;
  width: number;
  rows: number;
  columns: number;
  heights: number[];
}

export interface Model {
  robot: string;
  bodies: BodyModel[];
  shapes: ShapeModel[];
  chain: { left: SideModel; right: SideModel };
  obstacles: ObstacleModel[];
  marker: { position: Vec3; radius: number; facing: number } | null;
  rough: RoughModel | null;
  /** Of gravity against the floor's normal, rad, uphill positive. */
  slope: number;
}

type Packed =
  | { constant: number }
  | { f32: string }
  | { i16: string; offset: number; scale: number };

interface PackedContacts {
  /** Per row, how many contacts there are. */
  counts: string;
  /** Index of the body, per contact. */
  bodies: string;
  /** Index in `names` of what it touches, per contact. */
  others: string;
  names: string[];
  channels: Record<"x_mm" | "y_mm" | "z_mm" | "fx_n" | "fy_n" | "fz_n", Packed>;
}

interface PackedRun {
  title: string;
  facts: [string, string][];
  notes: string[];
  model: Model;
  rows: number;
  stages: [number, string][];
  channels: Record<string, Packed>;
  contacts: PackedContacts | null;
}

interface PackedRuns {
  format: string;
  version: number;
  runs: PackedRun[];
}

export interface Contact {
  body: number;
  other: string;
  /** m */
  at: Vec3;
  /** On the robot, N. */
  force: Vec3;
}

/** One run, unpacked. */
export class Run {
  readonly title: string;
  readonly facts: [string, string][];
  readonly notes: string[];
  readonly model: Model;
  readonly rows: number;
  readonly time: Float32Array;
  private readonly channels = new Map<string, Float32Array>();
  private readonly stages: [number, string][];
  private readonly contactStart: Uint32Array;
  private readonly contactList: Contact[] = [];

  constructor(packed: PackedRun) {
    this.title = packed.title;
    this.facts = packed.facts;
    this.notes = packed.notes;
    this.model = packed.model;
    this.rows = packed.rows;
    this.stages = packed.stages;
    for (const [name, channel] of Object.entries(packed.channels)) {
      this.channels.set(name, unpack(channel, packed.rows));
    }
    const time = this.channels.get("time_s");
    if (!time || packed.rows < 1) throw new Error("a run has no rows");
    this.time = time;
    this.contactStart = new Uint32Array(packed.rows + 1);
    if (packed.contacts) this.unpackContacts(packed.contacts);
  }

  /** A column of rows.csv, by its name there. */
  channel(name: string): Float32Array | undefined {
    return this.channels.get(name);
  }

  get begin(): number {
    return this.time[0] ?? 0;
  }

  get end(): number {
    return this.time[this.rows - 1] ?? 0;
  }

  /** The last row that is not after `time`, and how far on the way to the next the time is. */
  place(time: number): { row: number; part: number } {
    let low = 0;
    let high = this.rows - 1;
    if (time <= this.begin) return { row: 0, part: 0 };
    if (time >= this.end) return { row: high, part: 0 };
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if ((this.time[middle] ?? 0) <= time) low = middle;
      else high = middle;
    }
    const from = this.time[low] ?? 0;
    const to = this.time[high] ?? from;
    return { row: low, part: to > from ? (time - from) / (to - from) : 0 };
  }

  /** The row nearest to `time`. */
  nearest(time: number): number {
    const { row, part } = this.place(time);
    return part > 0.5 ? row + 1 : row;
  }

  stage(row: number): string {
    let found = "";
    for (const [from, name] of this.stages) {
      if (from > row) break;
      found = name;
    }
    return found;
  }

  contacts(row: number): Contact[] {
    return this.contactList.slice(this.contactStart[row] ?? 0, this.contactStart[row + 1] ?? 0);
  }

  get hasContacts(): boolean {
    return this.contactList.length > 0;
  }

  private unpackContacts(packed: PackedContacts): void {
    const counts = wholes(packed.counts);
    const bodies = wholes(packed.bodies);
    const others = wholes(packed.others);
    const get = (name: keyof PackedContacts["channels"]) =>
      unpack(packed.channels[name], bodies.length);
    const [x, y, z] = [get("x_mm"), get("y_mm"), get("z_mm")];
    const [fx, fy, fz] = [get("fx_n"), get("fy_n"), get("fz_n")];
    let total = 0;
    for (let row = 0; row < this.rows; row++) {
      this.contactStart[row] = total;
      total += counts[row] ?? 0;
    }
    this.contactStart[this.rows] = total;
    for (let i = 0; i < total; i++) {
      this.contactList.push({
        body: bodies[i] ?? 0,
        other: packed.names[others[i] ?? 0] ?? "",
        at: [(x[i] ?? 0) / 1e3, (y[i] ?? 0) / 1e3, (z[i] ?? 0) / 1e3],
        force: [fx[i] ?? 0, fy[i] ?? 0, fz[i] ?? 0],
      });
    }
  }
}

/** Reads the runs that the page carries. */
export function readRuns(text: string): Run[] {
  const packed = JSON.parse(text) as PackedRuns;
  if (packed.format !== "prone-replay" || packed.version !== FORMAT_VERSION) {
    throw new Error(`the page holds ${packed.format} ${packed.version}, not prone-replay ${FORMAT_VERSION}`);
  }
  return packed.runs.map((run) => new Run(run));
}

/** Stands for a value that was not a number. */
const NOT_A_NUMBER = -32768;

function unpack(packed: Packed, rows: number): Float32Array {
  const values = new Float32Array(rows);
  if ("constant" in packed) return values.fill(packed.constant);
  const view = new DataView(bytes("f32" in packed ? packed.f32 : packed.i16).buffer);
  for (let i = 0; i < rows; i++) {
    if ("f32" in packed) values[i] = view.getFloat32(4 * i, true);
    else {
      const whole = view.getInt16(2 * i, true);
      values[i] = whole === NOT_A_NUMBER ? NaN : packed.offset + packed.scale * whole;
    }
  }
  return values;
}

/** Whole numbers, 16 bits each. */
function wholes(base64: string): Uint16Array {
  const view = new DataView(bytes(base64).buffer);
  return Uint16Array.from({ length: view.byteLength / 2 }, (_, i) => view.getUint16(2 * i, true));
}

function bytes(base64: string): Uint8Array {
  const text = atob(base64);
  const values = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) values[i] = text.charCodeAt(i);
  return values;
}
