// The bodies in their true shapes and colours. Each body is a bone of one mesh.
import * as THREE from 'three';

import {mergeGeoms} from './shapes.js';

export class Bodies {
  constructor(recording) {
    this.recording = recording;
    this.bones = Array.from({length: recording.bodies}, () => new THREE.Bone());
    const geometry = mergeGeoms(recording);
    this.colours = new THREE.BufferAttribute(new Float32Array(3 * geometry.attributes.position.count), 3);
    geometry.setAttribute('color', this.colours.setUsage(THREE.DynamicDrawUsage));
    this.mesh = new THREE.SkinnedMesh(geometry, new THREE.MeshLambertMaterial({vertexColors: true}));
    this.mesh.bind(
        new THREE.Skeleton(this.bones, this.bones.map(() => new THREE.Matrix4())), new THREE.Matrix4());
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.partColours = recording.part_colours.map(toLinear);
    this.ramp = recording.ramp.map(toLinear);
    this.plain = toLinear(recording.plain_colour);
    this.position = new THREE.Vector3();
    this.orientation = new THREE.Quaternion();
    this.one = new THREE.Vector3(1, 1, 1);
    this.reach = reachOfBodies(geometry, recording.bodies);
  }

  place(frame) {
    this.bones.forEach((bone, body) => {
      this.recording.readPosition(frame, body, this.position);
      this.recording.readOrientation(frame, body, this.orientation);
      bone.matrixWorld.compose(this.position, this.orientation, this.one);
    });
  }

  paint(mode, measured, combination) {
    const {array} = this.colours, bodyOf = this.mesh.geometry.attributes.skinIndex.array;
    const ofBody = this.bones.map((_, body) => this.colour(mode, measured, combination, body));
    for (let i = 0; 3 * i < array.length; ++i) {
      const colour = ofBody[bodyOf[4 * i]];
      array[3 * i] = colour[0];
      array[3 * i + 1] = colour[1];
      array[3 * i + 2] = colour[2];
    }
    this.colours.needsUpdate = true;
  }

  colour(mode, measured, combination, body) {
    const {recording} = this;
    if (measured < 0) return this.plain;
    if (mode === 'island')
      return this.partColours[recording.islandColour[measured * recording.bodies + body]];
    const code = recording.ofBody(recording[mode], measured, combination, body);
    if (mode === 'part') {
      const colour = recording.ofBody(recording.partColour, measured, combination, body);
      return code === recording.no_part ? this.plain : this.partColours[colour];
    }
    return code === 255 ? this.plain : this.ramp[code];
  }

  // The largest value that each of some directions has over all corners of all bodies.
  furthest(directions) {
    const {position, skinIndex} = this.mesh.geometry.attributes, {array: at} = position;
    const turn = new THREE.Matrix3();
    return directions.map((direction) => {
      // In the frame of each body, so that corners need not be moved.
      const own = this.bones.map(
          ({matrixWorld}) => ({
            along: direction.clone().applyMatrix3(turn.setFromMatrix4(matrixWorld).transpose()),
            offset: this.position.setFromMatrixPosition(matrixWorld).dot(direction),
          }));
      let most = -Infinity;
      for (let i = 0; i < position.count; ++i) {
        const {along, offset} = own[skinIndex.array[4 * i]];
        most =
            Math.max(most, along.x * at[3 * i] + along.y * at[3 * i + 1] + along.z * at[3 * i + 2] + offset);
      }
      return most;
    });
  }

  // The body nearest to the eye whose surrounding sphere a ray meets; -1 for none.
  pick(ray) {
    let nearest = -1, least = Infinity;
    this.bones.forEach((bone, body) => {
      this.position.setFromMatrixPosition(bone.matrixWorld);
      const along = this.position.clone().sub(ray.origin).dot(ray.direction);
      if (ray.distanceSqToPoint(this.position) < this.reach[body] ** 2 && along < least)
        [nearest, least] = [body, along];
    });
    return nearest;
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.skeleton.dispose();
  }
}

function toLinear([r, g, b]) {
  return new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace).toArray();
}

function reachOfBodies(geometry, bodies) {
  const reach = new Float32Array(bodies), {position, skinIndex} = geometry.attributes;
  const corner = new THREE.Vector3();
  for (let i = 0; i < position.count; ++i) {
    const body = skinIndex.getX(i);
    reach[body] = Math.max(reach[body], corner.fromBufferAttribute(position, i).length());
  }
  return reach;
}
