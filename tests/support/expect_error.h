// EXPECT_INPUT_ERROR(expression, message): throws InputError with exactly this line.
#pragma once

#include <gtest/gtest.h>

#include "core/input_error.h"

#define EXPECT_INPUT_ERROR(expression, message)                  \
  try {                                                          \
    static_cast<void>(expression);                               \
    ADD_FAILURE() << #expression << " did not throw";            \
  } catch (const ::ensemble::InputError& error_) {               \
    EXPECT_EQ(std::string(error_.what()), std::string(message)); \
  }
