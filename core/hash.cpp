#include "core/hash.h"

#include <openssl/evp.h>

#include <array>
#include <cstdint>

#include "core/check.h"

namespace ensemble {

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  State() { ENSEMBLE_CHECK(EVP_DigestInit_ex(context, EVP_sha256(), nullptr) == 1); }
  ~State() { EVP_MD_CTX_free(context); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;

Sha256& Sha256::feed(std::span<const std::byte> bytes) {
  ENSEMBLE_CHECK(EVP_DigestUpdate(state_->context, bytes.data(), bytes.size()) == 1);
  return *this;
}

Sha256& Sha256::feed(std::string_view text) {
  feedValue(static_cast<std::uint64_t>(text.size()));
  return feed(std::as_bytes(std::span(text.data(), text.size())));
}

std::string Sha256::hex() {
  std::array<unsigned char, 32> digest{};
  unsigned int length = 0;
  ENSEMBLE_CHECK(EVP_DigestFinal_ex(state_->context, digest.data(), &length) == 1);
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
