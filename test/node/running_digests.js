// The digests of a recording computed again by a reader that shares no code with ROS (npm package @foxglove/rosbag), as
// docs/recording.md says. Prints what was compared; exit code 1 at the first digest that is not what the bag holds.
// usage: node running_digests.js BAG
'use strict';
const {Bag} = require('@foxglove/rosbag');
const {FileReader} = require('@foxglove/rosbag/node');

const START = 0xcbf29ce484222325n;
const word = new DataView(new ArrayBuffer(8));

function add(state, words) {
  for (const w of words) {
    state = BigInt.asUintN(64, (state ^ BigInt.asUintN(64, w)) * 0x9e3779b97f4a7c15n);
    state ^= state >> 32n;
  }
  return state;
}

function bits(number) {
  word.setFloat64(0, number);
  return word.getBigUint64(0);
}

// Bytes eight at a time, the first of them the lowest; the last word is filled up with zeros.
function words(bytes) {
  const padded = new Uint8Array(Math.ceil(bytes.length / 8) * 8);
  padded.set(bytes);
  const view = new DataView(padded.buffer);
  return Array.from({length: padded.length / 8}, (_, i) => view.getBigUint64(8 * i, true));
}

// A header is seq, stamp, and the length of a string before the string: 16 bytes, and all of them 0 in an empty one.
const bytesBehindHeader = (bytes) => bytes.subarray(16 + new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true));
const message = (bytes) => words(new Uint8Array([...new Uint8Array(16), ...bytesBehindHeader(bytes)]));

// Behind the header epoch, first_index and how many; each of them is as long as the others.
function impacts(bytes, count) {
  const all = bytesBehindHeader(bytes).subarray(16), length = all.length / count;
  return Array.from({length: count}, (_, i) => words(all.subarray(i * length, (i + 1) * length))).flat();
}

// topic: the digest its messages go into, and the words of one
const TOPICS = {
  deflection: ['samples', (m) => Array.from(m.vertical).flatMap((y, i) => [bits(y), bits(m.lateral[i])])],
  impacts: ['impacts', (m, bytes) => impacts(bytes, m.impacts.length)],
  applied_drag: ['commands', (m, bytes) => message(bytes)],
  applied_parameters: ['commands', (m, bytes) => message(bytes)],
  friction: ['estimates', (m, bytes) => message(bytes)],
};

function begin(bytes) {
  return {configuration: add(START, message(bytes)), samples: START, impacts: START, commands: START, estimates: START};
}

async function main(path) {
  const bag = new Bag(new FileReader(path));
  await bag.open();
  let digests, compared = 0;
  for await (const {topic, message, data} of bag.messageIterator()) {
    const name = topic.split('/').pop();
    if (name === 'configuration') digests = begin(data);
    if (name in TOPICS) {
      const [digest, wordsOf] = TOPICS[name];
      digests[digest] = add(digests[digest], wordsOf(message, data));
    }
    if (name !== 'digest') continue;
    const wrong = Object.keys(digests).filter((digest) => digests[digest] !== message[digest + '_digest']);
    if (wrong.length > 0) throw new Error(`digest ${compared}: not as recorded: ${wrong.join(', ')}`);
    console.log(`digest ${compared++}: ${message.samples} samples and ${message.impacts} impacts agree`);
  }
}

main(process.argv[2]).catch((error) => {
  console.error(error.message);
  process.exitCode = 1;
});
