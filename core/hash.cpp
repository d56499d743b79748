#include "core/hash.h"

// The functions of SHA-256 itself, deprecated since OpenSSL 3.0: the general ones (EVP) allocate, and where
// memory ends just then OpenSSL 3.0 crashes in a lock that it could not make.
#define OPENSSL_SUPPRESS_DEPRECATED
#include <openssl/sha.h>

#include <array>
#include <cstdint>

#include "core/check.h"

namespace ensemble {

struct Sha256::State {
  SHA256_CTX context{};
  State() { ENSEMBLE_CHECK(SHA256_Init(&context) == 1); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;

Sha256& Sha256::feed(std::span<const std::byte> bytes) {
  ENSEMBLE_CHECK(SHA256_Update(&state_->context, bytes.data(), bytes.size()) == 1);
  return *this;
}

Sha256& Sha256::feed(std::string_view text) {
  feedValue(static_cast<std::uint64_t>(text.size()));
  return feed(std::as_bytes(std::span(text.data(), text.size())));
}

std::string Sha256::hex() {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> digest{};
  ENSEMBLE_CHECK(SHA256_Final(digest.data(), &state_->context) == 1);
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : digest) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

std::string sha256Hex(std::span<const std::byte> bytes) { return Sha256().feed(bytes).hex(); }

}  // namespace ensemble
