// The constraint graph: balls at the bodies, sticks between bodies that share a constraint.
//
// Both are flat and turned to the eye by the graphics card, which shades them as if they were round: a ball
// is one point and a stick two triangles, so that thousands of them are quick without a graphics card too.
import * as THREE from 'three';

// Sticks inside a part. Those between parts are red and thicker, as all are of a solver that has no parts.
const INNER = new THREE.Color(0x6f757d);

export class Graph {
  constructor(recording) {
    this.recording = recording;
    this.edgeColour = toColour(recording.edge_colour);
    this.balls = makeBalls(recording);
    this.sticks = makeSticks(mostEdges(recording));
    this.group = new THREE.Group().add(this.sticks, this.balls);
    this.point = new THREE.Vector3();
    this.cutPairs = 0;
  }

  // pixels: size in pixels of something one metre large, one metre before the eye.
  setScale(pixels) {
    this.balls.material.uniforms.pixels.value = pixels;
  }

  place(frame, measured, combination) {
    const {recording} = this, {position} = this.balls.geometry.attributes;
    for (let body = 0; body < recording.bodies; ++body) {
      recording.readPosition(frame, body, this.point);
      position.setXYZ(body, this.point.x, this.point.y, this.point.z);
    }
    position.needsUpdate = true;
    this.placeSticks(position, measured, combination);
  }

  placeSticks({array: at}, measured, combination) {
    const {recording} = this, {start, end, colour, radius} = this.sticks.geometry.attributes;
    const first = measured < 0 ? 0 : recording.firstEdge[measured];
    const last = measured < 0 ? 0 : recording.firstEdge[measured + 1];
    const part = (body) => recording.ofBody(recording.part, measured, combination, body);
    this.cutPairs = 0;
    let i = 0;
    for (let edge = first; edge < last; ++edge) {
      const a = recording.edge[2 * edge], b = recording.edge[2 * edge + 1], cut = part(a) !== part(b);
      const inner = !cut && part(a) !== recording.no_part;
      const {r, g, b: blue} = inner ? INNER : this.edgeColour;
      this.cutPairs += cut;
      for (const corner = i + 4; i < corner; ++i) {
        start.setXYZ(i, at[3 * a], at[3 * a + 1], at[3 * a + 2]);
        end.setXYZ(i, at[3 * b], at[3 * b + 1], at[3 * b + 2]);
        colour.setXYZ(i, r, g, blue);
        radius.setX(i, recording.node_radius_m * (cut ? 0.4 : 0.2));
      }
    }
    this.sticks.geometry.setDrawRange(0, 6 * (last - first));
    for (const attribute of [start, end, colour, radius]) attribute.needsUpdate = true;
  }

  dispose() {
    for (const {geometry, material} of [this.balls, this.sticks]) {
      geometry.dispose();
      material.dispose();
    }
  }
}

function mostEdges({firstEdge}) {
  let most = 1;
  for (let i = 0; i + 1 < firstEdge.length; ++i) most = Math.max(most, firstEdge[i + 1] - firstEdge[i]);
  return most;
}

function toColour([r, g, b]) {
  return new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace);
}

const SHADE = `
  vec3 shade(vec3 colour, vec3 normal) {
    return colour * (0.55 + 0.55 * max(0.0, dot(normal, normalize(vec3(-0.5, 0.6, 0.7)))));
  }`;

function makeBalls({bodies, node_radius_m, node_colour}) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', dynamic(new THREE.BufferAttribute(new Float32Array(3 * bodies), 3)));
  const material = new THREE.ShaderMaterial({
    uniforms: {radius: {value: node_radius_m}, pixels: {value: 1}, colour: {value: toColour(node_colour)}},
    vertexShader: `
      uniform float radius, pixels;
      void main() {
        vec4 centre = modelViewMatrix * vec4(position, 1.0);
        gl_Position = projectionMatrix * centre;
        gl_PointSize = 2.0 * radius * pixels / -centre.z;
      }`,
    fragmentShader: `
      uniform vec3 colour;
      ${SHADE}
      void main() {
        vec2 across = vec2(2.0, -2.0) * (gl_PointCoord - 0.5);
        float squared = dot(across, across);
        if (squared > 1.0) discard;
        gl_FragColor = vec4(shade(colour, vec3(across, sqrt(1.0 - squared))), 1.0);
        #include <colorspace_fragment>
      }`,
  });
  return unculled(new THREE.Points(geometry, material));
}

function makeSticks(most) {
  const geometry = new THREE.BufferGeometry();
  // Of the four corners: which side of the axis, and which end.
  const corners = Array(most).fill([-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0]).flat();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(
      Array.from({length: most}, (_, i) => [0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner)).flat());
  for (const [name, size] of [['start', 3], ['end', 3], ['colour', 3], ['radius', 1]])
    geometry.setAttribute(name, dynamic(new THREE.BufferAttribute(new Float32Array(4 * size * most), size)));
  const material = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    vertexShader: `
      attribute vec3 start, end, colour;
      attribute float radius;
      varying vec3 tint, aside;
      varying float across;
      void main() {
        vec3 from = (modelViewMatrix * vec4(start, 1.0)).xyz, to = (modelViewMatrix * vec4(end, 1.0)).xyz;
        aside = normalize(cross(to - from, from + to) + vec3(1e-12, 0.0, 0.0));
        across = position.x;
        tint = colour;
        gl_Position = projectionMatrix * vec4(mix(from, to, position.y) + across * radius * aside, 1.0);
      }`,
    fragmentShader: `
      varying vec3 tint, aside;
      varying float across;
      ${SHADE}
      void main() {
        vec3 normal = across * aside + vec3(0.0, 0.0, sqrt(max(0.0, 1.0 - across * across)));
        gl_FragColor = vec4(shade(tint, normal), 1.0);
        #include <colorspace_fragment>
      }`,
  });
  return unculled(new THREE.Mesh(geometry, material));
}

function dynamic(attribute) {
  return attribute.setUsage(THREE.DynamicDrawUsage);
}

function unculled(object) {
  object.frustumCulled = false;
  return object;
}
