// Triangles of the shapes that bodies are made of, in the frames of their bodies.
import * as THREE from 'three';

const MOST_CORNERS = 60000;  // of all round shapes together

// One geometry of all geoms of a recording, each in the frame of its body, with an attribute `skinIndex` that
// names the body. One draw call for everything is what is quick everywhere; instances are slow without a
// graphics card.
export function mergeGeoms({geoms}) {
  const corners = geoms.length * 12 * 7 < MOST_CORNERS / 2 ? 20 : 12;
  const parts = geoms.map((geom) => ({body: geom.body, geometry: place(make(geom, corners), geom)}));
  const count = parts.reduce((sum, {geometry}) => sum + geometry.attributes.position.count, 0);
  const merged = new THREE.BufferGeometry();
  const position = new Float32Array(3 * count), normal = new Float32Array(3 * count);
  const skinIndex = new Uint16Array(4 * count), skinWeight = new Float32Array(4 * count), index = [];
  let first = 0;
  for (const {body, geometry} of parts) {
    position.set(geometry.attributes.position.array, 3 * first);
    normal.set(geometry.attributes.normal.array, 3 * first);
    for (const corner of geometry.index.array) index.push(first + corner);
    const next = first + geometry.attributes.position.count;
    for (let i = first; i < next; ++i) {
      skinIndex[4 * i] = body;
      skinWeight[4 * i] = 1;
    }
    first = next;
  }
  merged.setAttribute('position', new THREE.BufferAttribute(position, 3));
  merged.setAttribute('normal', new THREE.BufferAttribute(normal, 3));
  merged.setAttribute('skinIndex', new THREE.BufferAttribute(skinIndex, 4));
  merged.setAttribute('skinWeight', new THREE.BufferAttribute(skinWeight, 4));
  merged.setIndex(index);
  return merged;
}

function make({kind, size_m: [a, b, c], triangles_m}, corners) {
  return {
    box: () => new THREE.BoxGeometry(a, b, c),
    sphere: () => new THREE.SphereGeometry(a, corners, corners >> 1),
    cylinder: () => new THREE.CylinderGeometry(a, a, b, corners).rotateX(Math.PI / 2),
    capsule: () => new THREE.CapsuleGeometry(a, b, corners >> 2, corners >> 1).rotateX(Math.PI / 2),
    convex: () => makeHull(triangles_m),
  }[kind]();
}

// Flat faces: every triangle has corners of its own.
function makeHull(triangles_m) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(triangles_m.flat(2), 3));
  geometry.setIndex([...Array(3 * triangles_m.length).keys()]);
  geometry.computeVertexNormals();
  return geometry;
}

function place(geometry, {position_m, orientation_xyzw}) {
  return geometry.applyQuaternion(new THREE.Quaternion(...orientation_xyzw)).translate(...position_m);
}
