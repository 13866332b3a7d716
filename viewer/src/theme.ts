// Colours, light and dark. Those that carry meaning are safe for colour-blind readers (Okabe and
// Ito, 2008), somewhat darker on white and lighter on black.

export interface Theme {
  background: number;
  floor: number;
  earth: number;
  line: number;
  heavyLine: number;
  shadow: number;
  glass: number;
  solid: number;
  ghost: number;
  ink: string;
  faint: string;
  force: number;
  obstacleForce: number;
  mass: number;
  chain: number;
  series: string[];
}

const LIGHT: Theme = {
  background: 0xe9edf0,
  floor: 0xe1e5e8,
  earth: 0xd0d6db,
  line: 0xb4bcc3,
  heavyLine: 0x858e96,
  shadow: 0x3a444c,
  glass: 0x4c8fb8,
  solid: 0xc2b59b,
  ghost: 0x3b7fb5,
  ink: "#1d252b",
  faint: "#c9d0d5",
  force: 0x0072b2,
  obstacleForce: 0xd55e00,
  mass: 0x8a5a00,
  chain: 0xb83280,
  series: ["#0072b2", "#d55e00", "#00845f", "#b83280", "#8a6d00"],
};

const DARK: Theme = {
  background: 0x14191d,
  floor: 0x1b2126,
  earth: 0x262e34,
  line: 0x38424a,
  heavyLine: 0x5c6872,
  shadow: 0x000000,
  glass: 0x7db9dd,
  solid: 0x7d735f,
  ghost: 0x6bb4e8,
  ink: "#e6ebef",
  faint: "#333c44",
  force: 0x56b4e9,
  obstacleForce: 0xff8a3c,
  mass: 0xf0c53a,
  chain: 0xf07cc0,
  series: ["#56b4e9", "#ff8a3c", "#2fc497", "#f07cc0", "#e0c341"],
};

const dark = window.matchMedia("(prefers-color-scheme: dark)");

export function theme(): Theme {
  return dark.matches ? DARK : LIGHT;
}

export function onThemeChange(changed: () => void): void {
  dark.addEventListener("change", changed);
}
