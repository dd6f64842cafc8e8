#pragma once

#include <catch2/catch.hpp>
#include <string>

namespace rift::test {

/// One of two sides that must behave alike: left and right, x and y, roll and pitch.
class Side {
 public:
  explicit Side(bool is_first) : is_first_(is_first) {}

  bool IsFirst() const { return is_first_; }
  /// `value` on this side and `other` on the other one, in a struct of the two.
  template <class Pair, class T>
  Pair Of(const T& value, const T& other) const {
    return is_first_ ? Pair{value, other} : Pair{other, value};
  }
  /// The member that belongs to this side.
  template <class Struct, class T>
  T& In(Struct& object, T Struct::*first, T Struct::*second) const {
    return object.*(is_first_ ? first : second);
  }

 private:
  bool is_first_;
};

/// What has a side is tested on both by the same lines.
template <class Test>
void OnBothSides(const std::string& first, const std::string& second, const Test& test) {
  for (const bool is_first : {true, false}) {
    INFO("side: " << (is_first ? first : second));
    test(Side(is_first));
  }
}

}  // namespace rift::test
