/**
 * Reads snapshots of an instrument as the page does, and prints what it reads.
 *
 * The argument is the page's folder; each line of the input is a snapshot, each of the output what it reads.
 */

import { createInterface } from "node:readline";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";

const web = pathToFileURL(`${resolve(process.argv[2])}/`);
const { snapshotOf, targetOf } = await import(new URL("sound/snapshot.js", web).href);

for await (const line of createInterface({ input: process.stdin })) {
  const seen = Float64Array.from(JSON.parse(line), (number) => number ?? NaN);
  const snapshot = snapshotOf(seen);
  const shape = snapshot.shape.map((points) => Array.from(points));
  console.log(JSON.stringify({ ...snapshot, shape, target: targetOf(seen, "/bow/position") }));
}
