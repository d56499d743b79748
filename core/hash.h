// SHA-256 (OpenSSL).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace ensemble {

/// SHA-256 over what is fed, in lower-case hex.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  Sha256& feed(std::span<const std::byte> bytes);
  Sha256& feed(std::string_view text);  ///< its length, then its bytes
  template <class T>
  requires std::is_trivially_copyable_v<T> Sha256& feedValue(const T& value) {
    return feed(std::as_bytes(std::span(&value, 1)));
  }
  std::string hex();  ///< ends the hash

 private:
  struct State;
  std::unique_ptr<State> state_;
};

std::string sha256Hex(std::span<const std::byte> bytes);

}  // namespace ensemble
