// ENSEMBLE_CHECK: a caller's bug, on in release builds too. Bad input is not a bug: input_error.h.
#pragma once

#include <concepts>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace ensemble {

/// Thrown by a failed ENSEMBLE_CHECK; `what()` names the expression, both values and the place.
class CheckError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

namespace detail {

template <class T>
concept Streamable = requires(std::ostream& out, const T& value) {
  out << value;
};

/// Integers that std::cmp_less and its kin take: compared by value whatever their signs.
template <class L, class R>
concept ComparableIntegers = std::integral<L> && std::integral<R> && !std::same_as<L, bool> &&
                             !std::same_as<R, bool> && !std::same_as<L, char> && !std::same_as<R, char>;

template <class T>
void describe(std::ostream& out, const T& value) {
  if constexpr (Streamable<T>) {
    out << value;
  } else {
    out << "(unprintable)";
  }
}

/// Catches the two sides of a comparison so that both values can be printed.
template <class L>
struct CheckedLeft {
  const L& left;
  bool holds = true;
  std::string values;

  explicit operator bool() const { return holds; }

  template <class R>
  void compare(bool result, const R& right) {
    holds = result;
    if (holds) return;
    std::ostringstream out;
    describe(out, left);
    out << " vs. ";
    describe(out, right);
    values = out.str();
  }
  template <class R>
  CheckedLeft& operator==(const R& right) {
    if constexpr (ComparableIntegers<L, R>) {
      compare(std::cmp_equal(left, right), right);
    } else {
      compare(left == right, right);
    }
    return *this;
  }
  template <class R>
  CheckedLeft& operator!=(const R& right) {
    if constexpr (ComparableIntegers<L, R>) {
      compare(std::cmp_not_equal(left, right), right);
    } else {
      compare(left != right, right);
    }
    return *this;
  }
  template <class R>
  CheckedLeft& operator<(const R& right) {
    if constexpr (ComparableIntegers<L, R>) {
      compare(std::cmp_less(left, right), right);
    } else {
      compare(left < right, right);
    }
    return *this;
  }
  template <class R>
  CheckedLeft& operator<=(const R& right) {
    if constexpr (ComparableIntegers<L, R>) {
      compare(std::cmp_less_equal(left, right), right);
    } else {
      compare(left <= right, right);
    }
    return *this;
  }
  template <class R>
  CheckedLeft& operator>(const R& right) {
    if constexpr (ComparableIntegers<L, R>) {
      compare(std::cmp_greater(left, right), right);
    } else {
      compare(left > right, right);
    }
    return *this;
  }
  template <class R>
  CheckedLeft& operator>=(const R& right) {
    if constexpr (ComparableIntegers<L, R>) {
      compare(std::cmp_greater_equal(left, right), right);
    } else {
      compare(left >= right, right);
    }
    return *this;
  }
};

struct CheckStart {
  template <class L>
  CheckedLeft<L> operator<<(const L& left) const {
    CheckedLeft<L> checked{left, true, {}};
    if constexpr (requires { static_cast<bool>(left); }) checked.holds = static_cast<bool>(left);
    return checked;
  }
};

template <class L>
void verify(const CheckedLeft<L>& checked, const char* expression, const char* file, int line) {
  if (checked.holds) return;
  std::ostringstream out;
  out << file << ':' << line << ": check failed: " << expression;
  if (!checked.values.empty()) out << " (" << checked.values << ')';
  throw CheckError(out.str());
}

inline void verify(bool holds, const char* expression, const char* file, int line) {
  if (!holds)
    throw CheckError(std::string(file) + ':' + std::to_string(line) + ": check failed: " + expression);
}

}  // namespace detail
}  // namespace ensemble

/// ENSEMBLE_CHECK(a == b): throws CheckError with both values unless it holds.
#define ENSEMBLE_CHECK(...)                                                                           \
  ::ensemble::detail::verify(::ensemble::detail::CheckStart{} << __VA_ARGS__, #__VA_ARGS__, __FILE__, \
                             __LINE__)
