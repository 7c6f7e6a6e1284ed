// validate.mjs OBJECTS.json: each object of the list against the schema of its kind. Unknown keys are mistakes, too.
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
    const model = new Model(item);
    model.validate();
    if (JSON.stringify(sorted(model.toJSON())) !== JSON.stringify(sorted(item))) throw new Error('keys that the schema does not have');
    console.log(`good: ${name}`);
  } catch (error) {
    console.log(`WRONG: ${name}: ${error.message}`);
    failed += 1;
  }
}

function sorted(value) {
  if (Array.isArray(value)) return value.map(sorted);
  if (value === null || typeof value !== 'object') return value;
  return Object.fromEntries(Object.keys(value).sort().map((key) => [key, sorted(value[key])]));
}

const total = items.length - unknown;
console.log(`${Math.floor(((total - failed) * 100) / total)}% tests passed, ${failed} tests failed out of ${total}`);
process.exit(failed ? 1 : 0);
