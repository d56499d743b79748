// Usage: node draco_encode.cjs IN.glb OUT.glb POSITION_BITS
//
// Rewrites a GLB with KHR_draco_mesh_compression through Draco's own encoder and its default method
// (edgebreaker), which numbers vertices and faces anew as an artist's exporter would.
'use strict';
const fs = require('fs');
const draco3d = require('draco3dgltf');

const ARRAYS = {
  5120: Int8Array, 5121: Uint8Array, 5122: Int16Array, 5123: Uint16Array, 5125: Uint32Array, 5126: Float32Array,
};
const ADDERS = {
  5121: 'AddUInt8Attribute', 5123: 'AddUInt16Attribute', 5125: 'AddUInt32Attribute', 5126: 'AddFloatAttribute',
};
const WIDTHS = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16};
const DRACO_KINDS = {POSITION: 'POSITION', NORMAL: 'NORMAL', TEXCOORD_0: 'TEX_COORD'};

function readGlb(file) {
  const data = fs.readFileSync(file);
  const jsonLength = data.readUInt32LE(12);
  return {json: JSON.parse(data.toString('utf8', 20, 20 + jsonLength)), binary: data.subarray(28 + jsonLength)};
}

function readAccessor(glb, index) {
  const accessor = glb.json.accessors[index];
  const view = glb.json.bufferViews[accessor.bufferView];
  const start = (view.byteOffset || 0) + (accessor.byteOffset || 0);
  const ArrayType = ARRAYS[accessor.componentType];
  const length = accessor.count * WIDTHS[accessor.type];
  const bytes = Uint8Array.from(glb.binary.subarray(start, start + length * ArrayType.BYTES_PER_ELEMENT));
  return {values: new ArrayType(bytes.buffer), accessor};
}

// The primitive's compressed bytes, and Draco's ids of the attributes. Sets the counts that Draco gave.
function encodePrimitive(draco, glb, primitive, positionBits) {
  const mesh = new draco.Mesh();
  const builder = new draco.MeshBuilder();
  const encoder = new draco.Encoder();
  const vertexCount = glb.json.accessors[primitive.attributes.POSITION].count;
  const indices = primitive.indices === undefined ? Uint32Array.from({length: vertexCount}, (_, i) => i)
                                                  : Uint32Array.from(readAccessor(glb, primitive.indices).values);
  builder.AddFacesToMesh(mesh, indices.length / 3, indices);
  const ids = {};
  for (const [name, index] of Object.entries(primitive.attributes)) {
    const {values, accessor} = readAccessor(glb, index);
    const kind = draco[DRACO_KINDS[name] || 'GENERIC'];
    ids[name] = builder[ADDERS[accessor.componentType]](mesh, kind, accessor.count, WIDTHS[accessor.type], values);
  }
  encoder.SetAttributeQuantization(draco.POSITION, positionBits);
  encoder.SetAttributeQuantization(draco.NORMAL, 10);
  encoder.SetAttributeQuantization(draco.TEX_COORD, 12);
  encoder.SetEncodingMethod(draco.MESH_EDGEBREAKER_ENCODING);
  encoder.SetTrackEncodedProperties(true);
  const output = new draco.DracoInt8Array();
  const length = encoder.EncodeMeshToDracoBuffer(mesh, output);
  if (length <= 0) throw new Error('Draco could not encode a primitive');
  const bytes = Buffer.alloc(length);
  for (let i = 0; i < length; ++i) bytes[i] = output.GetValue(i) & 255;
  const counts = {vertices: encoder.GetNumberOfEncodedPoints(), corners: 3 * encoder.GetNumberOfEncodedFaces()};
  for (const object of [output, encoder, builder, mesh]) draco.destroy(object);
  return {bytes, ids, counts};
}

function writeGlb(file, json, binary) {
  json.buffers = [{byteLength: binary.length}];
  let text = Buffer.from(JSON.stringify(json));
  text = Buffer.concat([text, Buffer.alloc((4 - text.length % 4) % 4, 0x20)]);
  const header = Buffer.alloc(20);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(28 + text.length + binary.length, 8);
  header.writeUInt32LE(text.length, 12);
  header.write('JSON', 16, 'latin1');
  const chunk = Buffer.alloc(8);
  chunk.writeUInt32LE(binary.length, 0);
  chunk.write('BIN\0', 4, 'latin1');
  fs.writeFileSync(file, Buffer.concat([header, text, chunk, binary]));
}

async function main() {
  const [input, output, bits] = process.argv.slice(2);
  const draco = await draco3d.createEncoderModule();
  const glb = readGlb(input);
  const {json} = glb;
  const chunks = [];
  const views = [];
  let size = 0;
  const addView = (bytes) => {
    views.push({buffer: 0, byteOffset: size, byteLength: bytes.length});
    const padding = (4 - bytes.length % 4) % 4;
    chunks.push(bytes, Buffer.alloc(padding));
    size += bytes.length + padding;
    return views.length - 1;
  };

  const accessors = [];
  const addAccessor = (accessor) => accessors.push(accessor) - 1;
  for (const mesh of json.meshes) {
    for (const primitive of mesh.primitives) {
      const {bytes, ids, counts} = encodePrimitive(draco, glb, primitive, Number(bits));
      for (const name of Object.keys(primitive.attributes)) {
        const {bufferView, byteOffset, ...kept} = json.accessors[primitive.attributes[name]];
        primitive.attributes[name] = addAccessor({...kept, count: counts.vertices});
      }
      primitive.indices = addAccessor({componentType: 5125, count: counts.corners, type: 'SCALAR'});
      primitive.extensions = {KHR_draco_mesh_compression: {bufferView: addView(bytes), attributes: ids}};
    }
  }
  // Keep what is not of a mesh as it was: bind matrices, key frames, images.
  const keep = (index) => {
    const accessor = json.accessors[index];
    const view = json.bufferViews[accessor.bufferView];
    const start = view.byteOffset || 0;
    const bytes = glb.binary.subarray(start, start + view.byteLength);
    return addAccessor({...accessor, bufferView: addView(bytes)});
  };
  for (const skin of json.skins || []) skin.inverseBindMatrices = keep(skin.inverseBindMatrices);
  for (const animation of json.animations || []) {
    for (const sampler of animation.samplers) {
      sampler.input = keep(sampler.input);
      sampler.output = keep(sampler.output);
    }
  }
  for (const image of json.images || []) {
    const view = json.bufferViews[image.bufferView];
    image.bufferView = addView(glb.binary.subarray(view.byteOffset || 0, (view.byteOffset || 0) + view.byteLength));
  }
  json.accessors = accessors;
  json.bufferViews = views;
  for (const key of ['extensionsUsed', 'extensionsRequired']) {
    json[key] = [...new Set([...(json[key] || []), 'KHR_draco_mesh_compression'])];
  }
  writeGlb(output, json, Buffer.concat(chunks));
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
