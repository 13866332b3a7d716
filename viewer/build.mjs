// Bundles src/main.ts with three.js, uPlot and the styles into dist/viewer.js.
import { build } from "esbuild";
import { readFile } from "node:fs/promises";

const licence = async (name) => {
  const { version } = JSON.parse(await readFile(`node_modules/${name}/package.json`, "utf8"));
  const text = await readFile(`node_modules/${name}/LICENSE`, "utf8");
  return `${name} ${version}\n\n${text.trim()}`;
};

const licences = [await licence("three"), await licence("uplot")].join("\n\n");

await build({
  entryPoints: ["src/main.ts"],
  outfile: "dist/viewer.js",
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "ascii",
  legalComments: "none",
  loader: { ".css": "text" },
  banner: {
    js: `/*\nThe replay of prone, made by \`npm ci && npm run build\` in viewer/. It contains:\n\n${licences}\n*/`,
  },
  logLevel: "info",
});
