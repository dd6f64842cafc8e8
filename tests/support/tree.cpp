#include "support/tree.hpp"

namespace rift::test {

std::string SourceDir() { return RIFT_SOURCE_DIR; }
std::string BuildDir() { return RIFT_BINARY_DIR; }
std::string RiftBinary() { return BuildDir() + "/rift"; }

}  // namespace rift::test
