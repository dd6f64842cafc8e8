#pragma once

#include <memory>
#include <optional>

namespace rift::hardware {

/// Single key presses from the terminal, without Enter and without echo; nothing where stdin is no
/// terminal. The terminal is as before afterwards.
class OperatorKeys {
 public:
  OperatorKeys();
  ~OperatorKeys();
  OperatorKeys(const OperatorKeys&) = delete;
  OperatorKeys& operator=(const OperatorKeys&) = delete;

  bool IsTerminal() const { return saved_ != nullptr; }
  /// A key pressed since the last call, without waiting.
  std::optional<char> Pressed();

 private:
  struct Saved;
  std::unique_ptr<Saved> saved_;
};

}  // namespace rift::hardware
