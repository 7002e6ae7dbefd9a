// Reads a tileset as others do: loaders.gl opens it over HTTP and expands its implicit tiling, the
// Khronos validator checks every content and counts its triangles, and 3d-tiles-validator, where npm
// has it, checks the whole.
//
// usage: node read_tileset.mjs FOLDER_OF_NODE_MODULES TILESET_FOLDER
// Prints JSON: contents, triangles, boxes, issues, validator.
import {createServer} from 'node:http';
import {readFile} from 'node:fs/promises';
import {createRequire} from 'node:module';
import path from 'node:path';

const [modules, folder] = process.argv.slice(2);
const require = createRequire(path.join(modules, 'package.json'));
const {load} = require('@loaders.gl/core');
const {Tiles3DLoader} = require('@loaders.gl/3d-tiles');
const validator = require('gltf-validator');

const server = createServer(async (request, response) => {
  try {
    response.end(await readFile(path.join(folder, decodeURIComponent(request.url))));
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
const base = `http://127.0.0.1:${server.address().port}`;

const tileset = await load(`${base}/tileset.json`, Tiles3DLoader, {'3d-tiles': {loadGLTF: false}});
const issues = [];
const uris = new Set();
const errors = {};
let boxes = 0;
const visit = (tile, depth) => {
  if (!tile.boundingVolume?.box) issues.push(`a tile of depth ${depth} has no box`);
  boxes += 1;
  // A root without content keeps the template of all contents here.
  const uri = tile.contentUrl ?? tile.content?.uri;
  if (uri && !uri.includes('{level}')) {
    uris.add(new URL(uri, `${base}/`).pathname);
    errors[depth] = tile.lodMetricValue ?? tile.geometricError;
  }
  for (const child of tile.children ?? []) visit(child, depth + 1);
};
visit(tileset.root, 0);

let triangles = 0;
for (const uri of uris) {
  const bytes = new Uint8Array(await readFile(path.join(folder, uri)));
  const report = await validator.validateBytes(bytes, {maxIssues: 5});
  triangles += report.info.totalTriangleCount;
  for (const message of report.issues.messages)
    if (message.severity <= 1) issues.push(`${uri}: ${message.code} ${message.message} ${message.pointer}`);
}

let checked = 'not in the registry';
try {
  const {Validators} = require('3d-tiles-validator');
  const result = await Validators.validateTilesetFile(path.join(folder, 'tileset.json'));
  checked = `${result.numErrors} errors, ${result.numWarnings} warnings`;
  if (result.numErrors > 0) issues.push(result.serialize());
} catch (error) {
  if (error.code !== 'MODULE_NOT_FOUND') throw error;
}
server.close();
console.log(JSON.stringify({contents: uris.size, triangles, boxes, errors, issues, validator: checked}));
process.exit(0);
