// The woman and the man that the tests make.
#pragma once

#include "assetpipe/make_people.h"

namespace ensemble::testing {

inline PersonConfig configOf(Sex sex) {
  PersonConfig config;
  config.name = sex == Sex::kFemale ? "woman" : "man";
  config.figure = {sex, sex == Sex::kFemale ? 1.67f : 1.79f, 0.0f};
  config.seed = 3;
  return config;
}

}  // namespace ensemble::testing
