#include "bench/peers/ogre_person.h"

#include <Ogre.h>

#include <algorithm>
#include <cstring>

namespace ensemble::peers {
namespace {

// The rows of the blend of a vertex's four matrices, from the texture in which OGRE keeps them.
// uv0 to uv3: column of each row, for each joint; uv4: where the instance's matrices begin.
constexpr char kBlend[] = R"(#version 330
in vec4 vertex;
in vec3 normal;
in vec4 blendWeights;
in vec4 uv0, uv1, uv2, uv3;
in vec2 uv4;
in vec4 uv5, uv6, uv7;
uniform sampler2D bones;
uniform mat4 clip_from_world;
out vec3 world_normal;

mat3x4 matrixAt(ivec2 first, vec4 u, float width) {
  int column = first.x + int(u.x * width + 0.5);
  return mat3x4(texelFetch(bones, ivec2(column, first.y), 0), texelFetch(bones, ivec2(column + 1, first.y), 0),
                texelFetch(bones, ivec2(column + 2, first.y), 0));
}

mat3x4 blended() {
  ivec2 size = textureSize(bones, 0);
  ivec2 first = ivec2(uv4 * vec2(size));
  float width = float(size.x);
  return matrixAt(first, uv0, width) * blendWeights.x + matrixAt(first, uv1, width) * blendWeights.y +
         matrixAt(first, uv2, width) * blendWeights.z + matrixAt(first, uv3, width) * blendWeights.w;
}
)";

// mat3x4 holds rows as its columns: v * m is the moved point.
constexpr char kSharedMain[] = R"(
void main() {
  mat3x4 model = blended();
  vec4 point = vec4(vec4(vertex.xyz, 1.0) * model, 1.0);
  vec4 direction = vec4(vec4(normal, 0.0) * model, 0.0);
  mat3x4 world = mat3x4(uv5, uv6, uv7);
  world_normal = direction * world;
  gl_Position = clip_from_world * vec4(point * world, 1.0);
}
)";

constexpr char kOwnMain[] = R"(
void main() {
  mat3x4 world = blended();
  world_normal = vec4(normal, 0.0) * world;
  gl_Position = clip_from_world * vec4(vec4(vertex.xyz, 1.0) * world, 1.0);
}
)";

constexpr char kFragment[] = R"(#version 330
in vec3 world_normal;
uniform vec3 to_light, sun, ambient_up, ambient_down, colour;
out vec4 srgb;

void main() {
  // OGRE draws textures upside down, which makes front faces back faces.
  vec3 n = normalize(gl_FrontFacing ? -world_normal : world_normal);
  vec3 light = sun * max(dot(n, to_light), 0.0) + mix(ambient_down, ambient_up, n.y * 0.5 + 0.5);
  srgb = vec4(pow(colour * light, vec3(1.0 / 2.2)), 1.0);
}
)";

Ogre::Vector3 vector(const Triple& v) { return {v[0], v[1], v[2]}; }

/// A buffer of one interleaved source, filled by the caller.
Ogre::HardwareVertexBufferSharedPtr bindSource(Ogre::VertexData& data, unsigned short source) {
  auto buffer = Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
      data.vertexDeclaration->getVertexSize(source), data.vertexCount, Ogre::HardwareBuffer::HBU_STATIC,
      true);
  data.vertexBufferBinding->setBinding(source, buffer);
  return buffer;
}

// Blend indices and weights are a source of their own: the instance manager replaces it.
void fillVertices(const PeerMesh& mesh, Ogre::VertexData& data) {
  data.vertexCount = mesh.vertex_count;
  Ogre::VertexDeclaration& declaration = *data.vertexDeclaration;
  declaration.addElement(0, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  declaration.addElement(0, 12, Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  declaration.addElement(1, 0, Ogre::VET_FLOAT4, Ogre::VES_BLEND_WEIGHTS);
  declaration.addElement(1, 16, Ogre::VET_UBYTE4, Ogre::VES_BLEND_INDICES);
  Ogre::HardwareBufferLockGuard shape(bindSource(data, 0), Ogre::HardwareBuffer::HBL_DISCARD);
  Ogre::HardwareBufferLockGuard skin(bindSource(data, 1), Ogre::HardwareBuffer::HBL_DISCARD);
  auto* shape_bytes = static_cast<std::byte*>(shape.pData);
  auto* skin_bytes = static_cast<std::byte*>(skin.pData);
  for (std::size_t v = 0; v < mesh.vertex_count; ++v, shape_bytes += 24, skin_bytes += 20) {
    std::memcpy(shape_bytes, &mesh.positions[3 * v], 12);
    std::memcpy(shape_bytes + 12, &mesh.normals[3 * v], 12);
    std::memcpy(skin_bytes, &mesh.weights[4 * v], 16);
    std::memcpy(skin_bytes + 16, &mesh.joints[4 * v], 4);
  }
}

void fillIndices(const PeerMesh& mesh, Ogre::IndexData& data) {
  const bool wide = mesh.vertex_count > 65536;
  data.indexCount = mesh.indices.size();
  data.indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      wide ? Ogre::HardwareIndexBuffer::IT_32BIT : Ogre::HardwareIndexBuffer::IT_16BIT, data.indexCount,
      Ogre::HardwareBuffer::HBU_STATIC, true);
  Ogre::HardwareBufferLockGuard lock(data.indexBuffer, Ogre::HardwareBuffer::HBL_DISCARD);
  if (wide) {
    std::copy(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint32_t*>(lock.pData));
  } else {
    std::transform(mesh.indices.begin(), mesh.indices.end(), static_cast<std::uint16_t*>(lock.pData),
                   [](std::uint32_t index) { return static_cast<std::uint16_t>(index); });
  }
}

void addTrack(const PeerClip& clip, unsigned short joint, Ogre::Animation& animation, Ogre::Bone* bone) {
  Ogre::NodeAnimationTrack* track = animation.createNodeTrack(joint, bone);
  for (std::size_t key = 0; key < clip.key_count; ++key) {
    const float* m = clip.matrix(key, joint);
    const float time = clip.seconds * static_cast<float>(key) / static_cast<float>(clip.key_count - 1);
    Ogre::TransformKeyFrame* frame = track->createNodeKeyFrame(time);
    frame->setTranslate({m[3], m[7], m[11]});
    const Ogre::Matrix3 turn(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    frame->setRotation(Ogre::Quaternion(turn));
  }
}

Ogre::SkeletonPtr makeSkeleton(const PeerClip& clip) {
  Ogre::SkeletonPtr skeleton = Ogre::SkeletonManager::getSingleton().create("person.skeleton", kGroup, true);
  Ogre::Animation* animation = skeleton->createAnimation(kPersonClip, clip.seconds);
  for (unsigned short joint = 0; joint < clip.joint_count; ++joint) {
    addTrack(clip, joint, *animation, skeleton->createBone(std::to_string(joint), joint));
  }
  skeleton->setBindingPose();
  return skeleton;
}

void addProgram(const char* name, Ogre::GpuProgramType type, const std::string& source) {
  auto program = Ogre::HighLevelGpuProgramManager::getSingleton().createProgram(name, kGroup, "glsl", type);
  program->setSource(source);
}

}  // namespace

void makeOgrePerson(const PeerScene& scene) {
  Ogre::MeshPtr mesh = Ogre::MeshManager::getSingleton().createManual(kPersonMesh, kGroup);
  Ogre::SubMesh* part = mesh->createSubMesh();
  part->useSharedVertices = false;
  part->vertexData = OGRE_NEW Ogre::VertexData();
  fillVertices(scene.mesh, *part->vertexData);
  fillIndices(scene.mesh, *part->indexData);
  for (unsigned short joint = 0; joint < scene.clip.joint_count; ++joint) {
    part->blendIndexToBoneIndexMap.push_back(joint);
  }
  // Bounds that hold for every pose: a person's arms reach no farther.
  mesh->_setBounds(Ogre::AxisAlignedBox(-1.2f, -0.2f, -1.2f, 1.2f, 2.4f, 1.2f));
  mesh->_setBoundingSphereRadius(2.5f);
  Ogre::SkeletonPtr skeleton = makeSkeleton(scene.clip);
  mesh->_notifySkeleton(skeleton);
  mesh->load();
}

void makeOgreMaterial(const PeerScene& scene, bool shares_poses) {
  addProgram("person.vert", Ogre::GPT_VERTEX_PROGRAM,
             std::string(kBlend) + (shares_poses ? kSharedMain : kOwnMain));
  addProgram("person.frag", Ogre::GPT_FRAGMENT_PROGRAM, kFragment);
  Ogre::MaterialPtr material = Ogre::MaterialManager::getSingleton().create(kPersonMaterial, kGroup);
  Ogre::Pass* pass = material->getTechnique(0)->getPass(0);
  pass->setCullingMode(Ogre::CULL_NONE);
  pass->setVertexProgram("person.vert");
  pass->setFragmentProgram("person.frag");
  // By this name the instance manager finds where its texture belongs.
  pass->createTextureUnitState()->setName("InstancingVTF");
  auto vertex = pass->getVertexProgramParameters();
  vertex->setNamedAutoConstant("clip_from_world", Ogre::GpuProgramParameters::ACT_VIEWPROJ_MATRIX);
  vertex->setNamedConstant("bones", 0);
  auto fragment = pass->getFragmentProgramParameters();
  fragment->setNamedConstant("to_light", vector(scene.to_light));
  fragment->setNamedConstant("sun", vector(scene.sun));
  fragment->setNamedConstant("ambient_up", vector(scene.ambient_up));
  fragment->setNamedConstant("ambient_down", vector(scene.ambient_down));
  fragment->setNamedConstant("colour", vector(scene.colour));
  material->load();
}

}  // namespace ensemble::peers
