#include <catch2/catch.hpp>
#include <set>

#include "rift/sweep/run/slurm_options.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

TEST_CASE("The template of a cluster has every key, with its default") {
  const std::string file = test::SourceDir() + "/configs/engines/slurm.yaml";
  const yaml::Node tree = yaml::Parse(test::ReadFile(file), file);
  sweep::SlurmOptions options;
  yaml::Bind(tree, options);
  std::set<std::string> written, known;
  for (const yaml::Node::Entry& entry : tree.entries) written.insert(entry.key);
  const sweep::SlurmOptions defaults;
  for (const std::string& key : yaml::ListKeys(defaults)) {
    known.insert(key);
    INFO(key);
    CHECK(yaml::InlineText(yaml::GetValue(options, key)) ==
          yaml::InlineText(yaml::GetValue(defaults, key)));
  }
  CHECK(written == known);
}

}  // namespace
}  // namespace rift
