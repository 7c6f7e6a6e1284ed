// SPDX-License-Identifier: Apache-2.0
// validate.mjs OBJECTS.json: each object of the list against the schema of its kind. (Keys that it does not have are not found.)
import fs from 'node:fs';

const items = JSON.parse(fs.readFileSync(process.argv[2], 'utf8')).items;
const ours = ['v1', 'apps/v1', 'policy/v1'];
let failed = 0;
let unknown = 0;
for (const item of items) {
  const name = `${item.apiVersion} ${item.kind} ${item.metadata.name}`;
  if (!ours.includes(item.apiVersion)) {
    console.log(`no schema: ${name}`);
    unknown += 1;
    continue;
  }
  try {
    const Model = (await import(`kubernetes-models/${item.apiVersion}/${item.kind}`))[item.kind];
    new Model(item).validate();
    console.log(`good: ${name}`);
  } catch (error) {
    console.log(`WRONG: ${name}: ${error.message}`);
    failed += 1;
  }
}

const total = items.length - unknown;
console.log(`${Math.floor(((total - failed) * 100) / total)}% tests passed, ${failed} tests failed out of ${total}`);
process.exit(failed ? 1 : 0);
