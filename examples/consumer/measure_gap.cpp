// The Sim-to-Real gap of two logs, through the library: measure_gap SIM.csv REAL.csv
#include <fstream>
#include <iostream>
#include <iterator>

#include "rift/gap/comparison.hpp"
#include "rift/trajectory/log.hpp"

namespace {

rift::trajectory::Trajectory Read(const char* path) {
  std::ifstream file(path);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  return rift::trajectory::ReadLog(text, path).trajectory;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "measure_gap SIM.csv REAL.csv\n";
    return 2;
  }
  try {
    const auto found = rift::gap::Compare(Read(argv[1]), Read(argv[2]), rift::gap::GapOptions{});
    std::cout << found.gap_m << " m\n";
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
