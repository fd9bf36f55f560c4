// A recorded run as scripts/cleave_scripts/viewer/packing.py packs it: a description in JSON and one block of numbers, gzip in
// base64.
//
// Shapes as in motion.h5: s steps, k measured steps that were kept (kAll without thinning), c combinations, n
// bodies.

const TYPES = {
  u8: Uint8Array,
  u16: Uint16Array,
  i16: Int16Array,
  i32: Int32Array,
  f32: Float32Array
};

// [{name, load: async () => Recording}], one a recording of the section.
export function readRecordings(section) {
  return [...section.querySelectorAll('script.cleave-recording')].map(
      (script) => ({
        name: script.dataset.name,
        load: async () => {
          const {description, data} = JSON.parse(script.textContent);
          return new Recording(description, await unpack(data));
        },
      }));
}

async function unpack(base64) {
  const text = atob(base64);
  const packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

export class Recording {
  constructor(description, buffer) {
    Object.assign(this, description);
    for (const {name, type, first, count} of description.arrays)
      this[name] = new TYPES[type](buffer, first, count);
    this.steps = this.step.length;
    this.combinationCount = this.combinations.length;
    addUpSteps(this.position, 3 * this.bodies);
    addUpSteps(this.orientation, 4 * this.bodies);
  }

  // The last kept measured step that is not after a frame, as an index; -1 before the first.
  measuredAt(frame) {
    const step = this.step[frame];
    let low = 0, high = this.measuredStep.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.measuredStep[middle] <= step)
        low = middle + 1;
      else
        high = middle;
    }
    return low - 1;
  }

  readPosition(frame, body, vector) {
    const at = 3 * (frame * this.bodies + body), [x, y, z] = this.origin_m, size = this.unit_m;
    return vector.set(
        x + size * this.position[at], y + size * this.position[at + 1], z + size * this.position[at + 2]);
  }

  readOrientation(frame, body, quaternion) {
    const at = 4 * (frame * this.bodies + body), q = this.orientation;
    return quaternion.set(q[at + 1], q[at + 2], q[at + 3], q[at]).normalize();
  }

  // Entry of an array (k, c, n).
  ofBody(array, measured, combination, body) {
    return array[(measured * this.combinationCount + combination) * this.bodies + body];
  }

  // Index into arrays (kAll, c) of a kept measured step.
  curveIndex(measured, combination) {
    return this.keptOfAll[measured] * this.combinationCount + combination;
  }

  // The value that an 8-bit magnitude stands for: 0 zero, 255 not a number, else logarithmic.
  magnitude(range, code) {
    if (code === 0) return 0;
    if (code === 255) return NaN;
    return range.least * (range.most / range.least) ** ((code - 1) / 253);
  }
}

// Poses are stored as differences from the step before, in the wrap-around arithmetic of the array.
function addUpSteps(values, perStep) {
  for (let i = perStep; i < values.length; ++i) values[i] += values[i - perStep];
}
