// node read_mcap.mjs NODE_MODULES FILE: the file as Foxglove's own reader sees it, as JSON.
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {resolve} from 'node:path';

const [modules, file] = process.argv.slice(2);
const {McapStreamReader} = createRequire(resolve(modules, 'x.js'))('@mcap/core');
const reader = new McapStreamReader({validateCrcs: true});
reader.append(readFileSync(file));
const seen = {schemas: {}, topics: {}, done: false};
const channels = new Map();
for (let record; (record = reader.nextRecord());) {
  if (record.type === 'Schema') {
    seen.schemas[record.name] = JSON.parse(new TextDecoder().decode(record.data));
  } else if (record.type === 'Channel') {
    channels.set(record.id, record.topic);
    seen.topics[record.topic] = [];
  } else if (record.type === 'Message') {
    const message = JSON.parse(new TextDecoder().decode(record.data));
    seen.topics[channels.get(record.channelId)].push({time_ns: Number(record.logTime), message});
  }
}
seen.done = reader.done();
console.log(JSON.stringify(seen));
