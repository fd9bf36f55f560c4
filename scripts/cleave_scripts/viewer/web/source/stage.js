// Camera, lights, ground and the two passes of a picture: bodies, then the graph in front of them.
import * as THREE from 'three';
import {OrbitControls} from 'three/addons/controls/OrbitControls.js';

const SKY = 0xf3f5f8;
const MARGIN = 1.04;

export class Stage {
  constructor(canvas, onChange) {
    this.canvas = canvas;
    this.software = rendersInSoftware();
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: !this.software});
    this.renderer.autoClear = false;
    this.renderer.shadowMap.enabled = true;
    this.renderer.setClearColor(SKY);
    this.camera = new THREE.PerspectiveCamera();
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.addEventListener('change', onChange);
    this.orbit.addEventListener('start', () => this.following = false);
    this.front = new THREE.Scene();
    this.share = 1;  // of the window's pixels along each side
  }

  // A new world with its bodies and graph.
  show(recording, bodies, graph) {
    this.world = new THREE.Scene();
    this.sun = addLights(this.world);
    this.world.add(bodies.mesh, makeGround(recording));
    this.bodies = bodies;
    this.graph = graph;
    this.view = recording.view;
    this.camera.fov = recording.view.field_of_view;
    this.following = true;  // until the user turns the view
    this.front.clear().add(graph.group);
    this.light(recording.view);
  }

  // Moves the eye to where it just holds all bodies. A corner at (x, y, z) in the eye's frame is in view
  // while |x - c| <= t (D - z), so the least distance D for both sides of the canvas is known without any
  // search.
  follow() {
    if (!this.following) return;
    const back = new THREE.Vector3(...this.view.back);
    const right = new THREE.Vector3(0, 0, 1).cross(back).normalize();
    const up = back.clone().cross(right), {aspect} = this.camera;
    const slope = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)) / MARGIN;
    const sides = [[right, 1, slope * aspect], [right, -1, slope * aspect], [up, 1, slope], [up, -1, slope]];
    const [east, west, north, south, front, rear] = this.bodies.furthest([
      ...sides.map(([axis, sign, t]) => axis.clone().multiplyScalar(sign).addScaledVector(back, t)), back,
      back.clone().negate()
    ]);
    const distance = Math.max((east + west) / (2 * slope * aspect), (north + south) / (2 * slope));
    const target = this.orbit.target.set(0, 0, 0);
    target.addScaledVector(right, (east - west) / 2).addScaledVector(up, (north - south) / 2);
    this.camera.position.copy(target).addScaledVector(back, distance);
    target.addScaledVector(back, (front - rear) / 2);  // so that the view turns about the bodies
    const away = this.camera.position.distanceTo(target);
    Object.assign(this.camera, {near: away / 100, far: away * 20});
    this.camera.updateProjectionMatrix();
    this.orbit.update();
  }

  light(view) {
    const centre = new THREE.Vector3(...view.centre_m), r = view.radius_m;
    this.sun.position.set(-0.7, -0.9, 1.9).multiplyScalar(r).add(centre);
    this.sun.target.position.copy(centre);
    this.sun.target.updateMatrixWorld();
    const box = this.sun.shadow.camera;
    Object.assign(box, {left: -r, right: r, top: r, bottom: -r, near: 0.2 * r, far: 5 * r});
    box.updateProjectionMatrix();
    this.sun.shadow.bias = -1e-3;
    this.sun.shadow.normalBias = 0.004 * r;
  }

  // Until the next change; the picture has to be drawn again.
  setShare(share) {
    if (share === this.share) return;
    this.share = share;
    this.fit();
  }

  setShadows(on) {
    this.sun.castShadow = on;
  }

  fit() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    this.renderer.setPixelRatio(this.share * Math.min(window.devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / Math.max(height, 1);
    this.camera.updateProjectionMatrix();
    this.graph.setScale(
        this.renderer.domElement.height / (2 * Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2))));
  }

  draw(showGraph) {
    this.renderer.clear();
    this.renderer.render(this.world, this.camera);
    if (!showGraph) return;
    this.renderer.clearDepth();
    this.renderer.render(this.front, this.camera);
  }

  // The line of sight through a point of the canvas.
  rayAt(x, y) {
    const point =
        new THREE.Vector2(2 * x / this.canvas.clientWidth - 1, 1 - 2 * y / this.canvas.clientHeight);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(point, this.camera);
    return caster.ray;
  }
}

// Whether WebGL works without a graphics card; then smooth edges and shadows cost too much.
function rendersInSoftware() {
  const gl = document.createElement('canvas').getContext('webgl2');
  if (!gl) throw new Error('this browser offers no WebGL 2');
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  const name = info ? gl.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|softpipe|basic render|software/i.test(name);
}

function addLights(scene) {
  const sun = new THREE.DirectionalLight(0xffffff, 2.1);
  sun.shadow.mapSize.set(1024, 1024);
  scene.add(new THREE.HemisphereLight(0xffffff, 0xb9bdc6, 1.7), sun, sun.target);
  return sun;
}

// Planes as polygons that are seen from outside only, so that no wall hides the bodies; a grid on a lone
// floor.
function makeGround({ground, view}) {
  const group = new THREE.Group();
  for (const {corners_m, level, lone} of ground) {
    const geometry =
        new THREE.BufferGeometry().setFromPoints(corners_m.map((corner) => new THREE.Vector3(...corner)));
    geometry.setIndex(corners_m.slice(2).flatMap((_, i) => [0, i + 1, i + 2]));
    geometry.computeVertexNormals();
    const material = lone ?
        new THREE.ShadowMaterial({opacity: 0.25}) :
        new THREE.MeshLambertMaterial(
            {color: level ? 0xe9ebee : 0xd3d8df, transparent: true, opacity: level ? 1 : 0.75});
    const mesh = new THREE.Mesh(geometry, material);
    mesh.receiveShadow = true;
    group.add(mesh);
    if (lone) group.add(makeGrid(corners_m[0][2], view));
  }
  return group;
}

// One square metre a square, or ten by ten of them where the view is wide.
function makeGrid(height, {centre_m, radius_m}) {
  const square = radius_m > 30 ? 10 : 1, count = 2 * Math.ceil(2 * radius_m / square);
  const grid = new THREE.GridHelper(count * square, count, 0xc3c9d2, 0xdde1e7).rotateX(Math.PI / 2);
  grid.position.set(Math.round(centre_m[0]), Math.round(centre_m[1]), height - 0.002 * radius_m);
  return grid;
}
