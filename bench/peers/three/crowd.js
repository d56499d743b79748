// A peer to measure against: three.js draws the exported crowd by instancing, skinned in the vertex shader from a
// texture of the clip's bone matrices. Sends one JSON object, and the first frame's pixels, to run.py.
//
// All poses stay in the texture, so that a frame costs the browser's script one uniform and one draw: three.js' own
// SkinnedMesh and InstancedMesh have nothing as fast.
import * as THREE from "three";

const vertexShader = `
precision highp sampler2D;
in vec4 weights;
in uvec4 joints;
in vec4 place;  // x, z, heading, phase
uniform sampler2D poses;  // 3 texels a joint, a row of the texture a key
uniform float key_intervals, key;
out vec3 world_normal;

mat3x4 matrixAt(int pose, uint joint) {
  int column = 3 * int(joint);
  return mat3x4(texelFetch(poses, ivec2(column, pose), 0), texelFetch(poses, ivec2(column + 1, pose), 0),
                texelFetch(poses, ivec2(column + 2, pose), 0));
}

mat3x4 blended(int pose) {
  return matrixAt(pose, joints.x) * weights.x + matrixAt(pose, joints.y) * weights.y +
         matrixAt(pose, joints.z) * weights.z + matrixAt(pose, joints.w) * weights.w;
}

// mat3x4 holds rows as its columns: v * m is the moved point.
mat3x4 posed() {
  float at = mod(place.w * key_intervals + key, key_intervals);
#ifdef INTERPOLATED
  int first = min(int(at), int(key_intervals) - 1);
  float part = at - float(first);
  return blended(first) * (1.0 - part) + blended(first + 1) * part;
#else
  return blended(int(at + 0.5) % int(key_intervals));
#endif
}

void main() {
  mat3x4 model = posed();
  vec3 point = vec4(position, 1.0) * model;
  vec3 direction = vec4(normal, 0.0) * model;
  float c = cos(place.z), s = sin(place.z);
  mat3 turn = mat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c);
  world_normal = turn * direction;
  gl_Position = projectionMatrix * viewMatrix * vec4(turn * point + vec3(place.x, 0.0, place.y), 1.0);
}`;

const fragmentShader = `
in vec3 world_normal;
uniform vec3 to_light, sun, ambient_up, ambient_down, colour;
out vec4 srgb;

void main() {
  vec3 n = normalize(gl_FrontFacing ? world_normal : -world_normal);
  vec3 light = sun * max(dot(n, to_light), 0.0) + mix(ambient_down, ambient_up, n.y * 0.5 + 0.5);
  srgb = vec4(pow(colour * light, vec3(1.0 / 2.2)), 1.0);
}`;

async function fetchOk(name) {
  const answer = await fetch(`/scene/${name}`);
  if (!answer.ok) throw new Error(`${name}: ${answer.status}`);
  return answer;
}

async function readMesh(entry) {
  const bytes = await (await fetchOk(entry.file)).arrayBuffer();
  let offset = 0;
  const take = (type, count) => {
    const values = new type(bytes, offset, count);
    offset += values.byteLength;
    return values;
  };
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(take(Float32Array, entry.vertices * 3), 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(take(Float32Array, entry.vertices * 3), 3));
  geometry.setAttribute("weights", new THREE.BufferAttribute(take(Float32Array, entry.vertices * 4), 4));
  const joints = new THREE.BufferAttribute(take(Uint8Array, entry.vertices * 4), 4);
  joints.gpuType = THREE.IntType;
  geometry.setAttribute("joints", joints);
  const indices = take(Uint32Array, entry.triangles * 3);
  geometry.setIndex(new THREE.BufferAttribute(entry.vertices > 65536 ? indices : new Uint16Array(indices), 1));
  return geometry;
}

async function readPeople(name, count) {
  const [header, ...lines] = (await (await fetchOk(name)).text()).trim().split("\n");
  const names = header.split(",");
  const [x, z, heading, phase] = ["x", "z", "heading", "phase"].map((column) => names.indexOf(column));
  const people = new Float32Array(count * 4);
  for (let i = 0; i < count; ++i) {
    const fields = lines[i].split(",").map(Number);
    people.set([fields[x], fields[z], (fields[heading] * Math.PI) / 180, fields[phase]], 4 * i);
  }
  return new THREE.InstancedBufferAttribute(people, 4);
}

async function readPoses(entry) {
  const matrices = new Float32Array(await (await fetchOk(entry.file)).arrayBuffer());
  const texture = new THREE.DataTexture(matrices, entry.joints * 3, entry.keys, THREE.RGBAFormat, THREE.FloatType);
  texture.needsUpdate = true;
  return texture;
}

function makeMaterial(scene, poses, interpolated) {
  const vector = (values) => ({ value: new THREE.Vector3(...values) });
  return new THREE.ShaderMaterial({
    glslVersion: THREE.GLSL3,
    side: THREE.DoubleSide,
    defines: interpolated ? { INTERPOLATED: 1 } : {},
    uniforms: {
      poses: { value: poses },
      key_intervals: { value: scene.poses.keys - 1 },
      key: { value: 0 },
      to_light: { value: new THREE.Vector3(...scene.light.direction).normalize().negate() },
      sun: vector(scene.light.sun),
      ambient_up: vector(scene.light.ambient_up),
      ambient_down: vector(scene.light.ambient_down),
      colour: vector(scene.colour),
    },
    vertexShader,
    fragmentShader,
  });
}

function makeCamera(scene, view) {
  const camera = new THREE.PerspectiveCamera(view.fov_y, scene.width / scene.height, view.near, view.far);
  camera.position.set(...view.position);
  camera.lookAt(...view.target);
  return camera;
}

/// What draws a frame, and waits until it is finished: WebGL's own finish() does not.
function makeDrawer(scene, view, mesh) {
  const renderer = new THREE.WebGLRenderer({ antialias: false });
  renderer.setClearColor(0x000000, 0);
  const target = new THREE.WebGLRenderTarget(scene.width, scene.height, { samples: 0 });
  const world = new THREE.Scene();
  world.add(mesh);
  const camera = makeCamera(scene, view);
  renderer.setRenderTarget(target);
  const gl = renderer.getContext();
  const pixel = new Uint8Array(4);
  const draw = (key) => {
    mesh.material.uniforms.key.value = key;
    renderer.render(world, camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
  };
  const picture = () => {
    const pixels = new Uint8Array(scene.width * scene.height * 4);
    gl.readPixels(0, 0, scene.width, scene.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    return pixels;
  };
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  const device = gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  return { draw, picture, device, triangles: () => renderer.info.render.triangles };
}

async function measure(options) {
  const scene = await (await fetchOk("scene.json")).json();
  const characters = Number(options.get("characters"));
  const view = scene.views.find((v) => v.name === options.get("view") && v.characters === characters);
  if (!view) throw new Error("the scene has no such view");
  const geometry = await readMesh(scene.meshes[options.get("order")]);
  geometry.setAttribute("place", await readPeople(scene.crowds[options.get("poses")], characters));
  geometry.instanceCount = characters;
  const material = makeMaterial(scene, await readPoses(scene.poses), options.get("poses") === "interpolated");
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  const drawer = makeDrawer(scene, view, mesh);

  drawer.draw(0);
  await fetch("/picture", { method: "POST", body: drawer.picture() });
  const warm = Number(options.get("warm"));
  for (let i = 0; i < warm; ++i) drawer.draw(1 + i);
  const frame_ms = [];
  for (let i = 0; i < Number(options.get("frames")); ++i) {
    const begin = performance.now();
    drawer.draw(1 + warm + i);
    frame_ms.push(performance.now() - begin);
  }
  return {
    peer: "three",
    variant: `${options.get("order")} ${options.get("poses")}`,
    characters,
    triangles: drawer.triangles(),
    device: drawer.device,
    frame_ms,
  };
}

measure(new URLSearchParams(location.search))
  .catch((error) => ({ peer: "three", error: String(error) }))
  .then((result) => fetch("/result", { method: "POST", body: JSON.stringify(result) }));
