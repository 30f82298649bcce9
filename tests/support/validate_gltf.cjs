// SPDX-License-Identifier: GPL-3.0-or-later
// Prints what the validator of Khronos says about a glTF file, as JSON. `node validate_gltf.cjs FILE
// NODE_MODULES`
"use strict";

const fs = require("node:fs");
const { createRequire } = require("node:module");
const path = require("node:path");

const [file, modules] = process.argv.slice(2);
const validator = createRequire(path.resolve(modules, "..", "index.js"))("gltf-validator");
validator.validateBytes(new Uint8Array(fs.readFileSync(file)))
  .then((report) => console.log(JSON.stringify(report.issues)));
