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

const time = (t) => [t.tau, bits(t.phase)];
const impact = (i) => [...time(i.time), bits(i.surface_phase), bits(i.normal_speed), bits(i.tangential_velocity),
  bits(i.energy_loss), BigInt(i.kind), BigInt(i.count)];

const level = (m) => [BigInt(m.model === 'hammer'), bits(m.contact_tolerance), bits(m.expected_error), bits(m.energy_dropped)];

// topic: the digest its messages go into, and the words of one
const TOPICS = {
  deflection: ['samples', (m) => Array.from(m.vertical).flatMap((y, i) => [bits(y), bits(m.lateral[i])])],
  impacts: ['impacts', (m) => m.impacts.flatMap(impact)],
  applied_drag: ['commands', (m) => [...time(m.time), bits(m.drag_velocity), m.first_impact,
    ...level(m)]],
  applied_parameters: ['commands', (m) => [...time(m.time), m.first_impact, m.first_sample, m.first_command,
    ...[m.restitution_gamma, m.cutoff_speed, m.rest_height_m, m.sample_rate_hz, m.friction_window_tau].map(bits),
    m.samples_per_batch, bits(m.sample_period_tau), ...level(m)]],
  friction: ['estimates', (m) => [...time(m.time), ...[m.drag_velocity, m.eta, m.force, m.force_std_error, m.k_f,
    m.k_f_std_error, m.k_f_tau_per_m, m.energy_loss, m.window_force, m.window_k_f, m.window_k_f_std_error].map(bits),
  m.impact_count]],
};

// bytes: of the message of the configuration, whose header is left out: an empty one is 16 bytes of 0
function begin(bytes) {
  const frame = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
  const configuration = add(START, [...new Uint8Array(16), ...bytes.subarray(16 + frame)].map(BigInt));
  return {configuration, samples: START, impacts: START, commands: START, estimates: START};
}

async function main(path) {
  const bag = new Bag(new FileReader(path));
  await bag.open();
  let digests, compared = 0;
  for await (const {topic, message, data} of bag.messageIterator()) {
    const name = topic.split('/').pop();
    if (name === 'configuration') digests = begin(data);
    if (name in TOPICS) {
      const [digest, words] = TOPICS[name];
      digests[digest] = add(digests[digest], words(message));
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
