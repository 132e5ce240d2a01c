// Answers requests, a JSON object a line: {"render": svg} with the pixels of resvg, {"svgo": svg} with lighter text,
// {"atlas": name} with a map of the package world-atlas as GeoJSON.
import { createRequire } from "node:module";
import { createInterface } from "node:readline";
import { writeSync } from "node:fs";

const require = createRequire(`${process.argv[2]}/package.json`);
const { Resvg } = require("@resvg/resvg-js");
const { optimize } = require("svgo");
const { feature } = require("topojson-client");
const font = { loadSystemFonts: false };

function answer(request) {
  if (request.svgo !== undefined) return [{}, Buffer.from(optimize(request.svgo).data)];
  if (request.atlas !== undefined) {
    const map = require(`world-atlas/${request.atlas}.json`);
    return [{}, Buffer.from(JSON.stringify(feature(map, map.objects[request.atlas.split("-")[0]])))];
  }
  const { width, height } = new Resvg(request.render, { font });
  const fitTo = { mode: width >= height ? "width" : "height", value: request.size };
  const image = new Resvg(request.render, { font, fitTo, background: "white" }).render();
  return [{ width: image.width, height: image.height, units: [width, height] }, image.pixels];
}

function send(bytes) {
  for (let at = 0; at < bytes.length; ) {
    try {
      at += writeSync(1, bytes, at);
    } catch (error) {
      if (error.code !== "EAGAIN") throw error; // the pipe is full
    }
  }
}

for await (const line of createInterface({ input: process.stdin })) {
  let found;
  try {
    found = answer(JSON.parse(line));
  } catch (error) {
    found = [{ error: String(error.message ?? error) }, Buffer.alloc(0)];
  }
  send(Buffer.from(JSON.stringify({ ...found[0], bytes: found[1].length }) + "\n"));
  send(found[1]);
}
