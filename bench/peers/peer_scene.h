// The scene that export_character.py wrote: one mesh, one clip's poses, a crowd and its cameras.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ensemble::peers {

using Triple = std::array<float, 3>;

struct PeerMesh {
  std::size_t vertex_count = 0;
  std::vector<float> positions, normals;  ///< 3 a vertex, metres
  std::vector<float> weights;             ///< 4 a vertex; they sum to one
  std::vector<std::uint8_t> joints;       ///< 4 a vertex
  std::vector<std::uint32_t> indices;     ///< 3 a triangle
};

/// A clip that loops in place: the last key is the first again.
struct PeerClip {
  std::size_t key_count = 0, joint_count = 0;
  float seconds = 0.0f;
  /// Skinning matrices, inverse bind pose folded in: three rows of four floats, by key, then by joint. Rigid.
  std::vector<float> matrices;

  const float* matrix(std::size_t key, std::size_t joint) const {
    return matrices.data() + (key * joint_count + joint) * 12;
  }
};

struct PeerPerson {
  float x = 0.0f, z = 0.0f;  ///< metres
  float heading_degrees = 0.0f;
  float phase = 0.0f;  ///< part of the clip that has run at time 0
};

struct PeerScene {
  unsigned width = 0, height = 0;
  Triple to_light = {}, sun = {}, ambient_up = {}, ambient_down = {}, colour = {};
  Triple camera = {}, target = {};
  float fov_y_degrees = 0.0f, near_plane = 0.0f, far_plane = 0.0f;
  PeerMesh mesh;
  PeerClip clip;
  std::vector<PeerPerson> people;
};

/// Which of the scene's variants is drawn.
struct PeerChoice {
  std::filesystem::path folder;
  std::string order = "exported";  ///< of the mesh: exported, optimised
  std::string poses = "keys";      ///< of the crowd: keys, interpolated
  std::string view = "near";
  std::size_t characters = 1000;
};

/// @throws std::runtime_error for a file that is missing or is not what it should be
PeerScene readPeerScene(const PeerChoice& choice);

}  // namespace ensemble::peers
