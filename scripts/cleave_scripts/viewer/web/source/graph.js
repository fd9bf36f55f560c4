// The constraint graph: balls at the bodies, sticks between bodies that share a constraint.
//
// Both are flat and turned to the eye by the graphics card, which shades them as if they were round: a ball
// is one point and a stick two triangles, so that thousands of them are quick without a graphics card too.
import * as THREE from 'three';

export class Graph {
  constructor(recording) {
    this.recording = recording;
    // Sticks between parts are red, thicker and cased, as all are of a solver that has no parts.
    this.edgeColour = toColour(recording.edge_colour);
    this.innerColour = toColour(recording.inner_edge_colour);
    this.balls = makeBalls(recording);
    this.sticks = makeSticks(mostEdges(recording));
    this.casings = makeCasings(this.sticks.geometry, recording);
    this.group = new THREE.Group().add(this.casings, this.sticks, this.balls);
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
    const {recording} = this, {start, end, colour, radius, cased} = this.sticks.geometry.attributes;
    const first = measured < 0 ? 0 : recording.firstEdge[measured];
    const last = measured < 0 ? 0 : recording.firstEdge[measured + 1];
    const part = (body) => recording.ofBody(recording.part, measured, combination, body);
    this.cutPairs = 0;
    let i = 0;
    for (let edge = first; edge < last; ++edge) {
      const a = recording.edge[2 * edge], b = recording.edge[2 * edge + 1], cut = part(a) !== part(b);
      const inner = !cut && part(a) !== recording.no_part;
      const {r, g, b: blue} = inner ? this.innerColour : this.edgeColour;
      this.cutPairs += cut;
      for (const corner = i + 4; i < corner; ++i) {
        start.setXYZ(i, at[3 * a], at[3 * a + 1], at[3 * a + 2]);
        end.setXYZ(i, at[3 * b], at[3 * b + 1], at[3 * b + 2]);
        colour.setXYZ(i, r, g, blue);
        radius.setX(i, recording.node_radius_m * (cut ? 0.4 : 0.2));
        cased.setX(i, inner ? 0 : 1);
      }
    }
    this.sticks.geometry.setDrawRange(0, 6 * (last - first));
    for (const attribute of [start, end, colour, radius, cased]) attribute.needsUpdate = true;
  }

  dispose() {
    for (const {geometry, material} of [this.balls, this.sticks, this.casings]) {
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

// A corner of a stick so far aside of its axis, in the plane that faces the eye.
const PLACE = `
  attribute vec3 start, end;
  attribute float radius;
  vec4 place(float offset, out vec3 aside) {
    vec3 from = (modelViewMatrix * vec4(start, 1.0)).xyz, to = (modelViewMatrix * vec4(end, 1.0)).xyz;
    aside = normalize(cross(to - from, from + to) + vec3(1e-12, 0.0, 0.0));
    return projectionMatrix * vec4(mix(from, to, position.y) + offset * aside, 1.0);
  }`;

function makeSticks(most) {
  const geometry = new THREE.BufferGeometry();
  // Of the four corners: which side of the axis, and which end.
  const corners = Array(most).fill([-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0]).flat();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setIndex(
      Array.from({length: most}, (_, i) => [0, 1, 2, 0, 2, 3].map((corner) => 4 * i + corner)).flat());
  for (const [name, size] of [['start', 3], ['end', 3], ['colour', 3], ['radius', 1], ['cased', 1]])
    geometry.setAttribute(name, dynamic(new THREE.BufferAttribute(new Float32Array(4 * size * most), size)));
  const material = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    vertexShader: `
      attribute vec3 colour;
      varying vec3 tint, aside;
      varying float across;
      ${PLACE}
      void main() {
        across = position.x;
        tint = colour;
        gl_Position = place(across * radius, aside);
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

// Flat and wider, drawn before all sticks: a line stays apart from parts of whatever colour, crossings stay
// whole.
function makeCasings(geometry, {edge_casing_colour, edge_casing_scale}) {
  const material = new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    depthWrite: false,
    uniforms: {scale: {value: edge_casing_scale}, colour: {value: toColour(edge_casing_colour)}},
    vertexShader: `
      attribute float cased;
      uniform float scale;
      ${PLACE}
      void main() {
        vec3 aside;
        gl_Position = place(position.x * cased * scale * radius, aside);
      }`,
    fragmentShader: `
      uniform vec3 colour;
      void main() {
        gl_FragColor = vec4(colour, 1.0);
        #include <colorspace_fragment>
      }`,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = -1;
  return unculled(mesh);
}

function dynamic(attribute) {
  return attribute.setUsage(THREE.DynamicDrawUsage);
}

function unculled(object) {
  object.frustumCulled = false;
  return object;
}
