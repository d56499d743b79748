// Usage: node gltf_validate.cjs FILE.glb...
//
// Prints what the Khronos glTF validator says of each file as JSON, one line a file: how many errors
// and warnings there are, and the text of the errors.
'use strict';
const fs = require('fs');
const validator = require('gltf-validator');

async function main() {
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {uri: file, maxIssues: 0});
    const {numErrors, numWarnings, messages} = report.issues;
    const texts = messages.filter((message) => message.severity === 0)
                      .map((message) => `${message.pointer || message.offset}: ${message.message}`);
    console.log(JSON.stringify({file, errors: numErrors, warnings: numWarnings, texts}));
  }
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
