// Whether pages are valid HTML: node test/validate.mjs PAGE…
//
// Ends with 77 where the validator is not installed (npm ci).

import { readFileSync } from "node:fs";

const NO_VALIDATOR = 77;

const { HtmlValidate } = await import("html-validate").catch(() => {
  console.error("html-validate is not installed");
  process.exit(NO_VALIDATOR);
});

const validator = new HtmlValidate({
  extends: ["html-validate:standard", "html-validate:a11y"],
  elements: ["html5"],
});

let complaints = 0;
for (const file of process.argv.slice(2)) {
  const text = readFileSync(file, "utf8");
  const pages = [[file, text]];
  // The page in the frame is a page too.
  const framed = /srcdoc="([^"]*)"/.exec(text);
  if (framed) pages.push([`${file}, frame`, unescaped(framed[1])]);
  for (const [name, page] of pages) {
    const { results } = await validator.validateString(page);
    for (const { messages } of results) {
      for (const { line, column, ruleId, message } of messages) {
        complaints += 1;
        console.error(`${name}:${line}:${column}: ${message} (${ruleId})`);
      }
    }
    console.log(`${name}: ${page.length} characters`);
  }
}
process.exit(complaints > 0 ? 1 : 0);

function unescaped(attribute) {
  const named = { "&lt;": "<", "&gt;": ">", "&quot;": '"', "&amp;": "&" };
  return attribute.replace(/&(?:lt|gt|quot|amp);/g, (entity) => named[entity]);
}
