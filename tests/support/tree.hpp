#pragma once

#include <string>

/// Where the tree and its build are. Only tree.cpp is compiled with these paths, so that a compiler
/// cache serves every other test in any clone.
namespace rift::test {

std::string SourceDir();
std::string BuildDir();
/// The program under test.
std::string RiftBinary();

}  // namespace rift::test
