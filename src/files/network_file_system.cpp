#include "rift/files/network_file_system.hpp"

#include <sys/vfs.h>

#include <algorithm>
#include <array>

namespace rift::files {
namespace {

struct Kind {
  unsigned long type;
  std::string_view name;
};

// statfs(2), linux/magic.h, and the sources of those that are not in Linux.
constexpr std::array kKinds{
    Kind{0x6969, "NFS"},          Kind{0x517B, "SMB"},        Kind{0xFF534D42, "CIFS"},
    Kind{0xFE534D42, "SMB2"},     Kind{0x0BD00BD0, "Lustre"}, Kind{0x47504653, "GPFS"},
    Kind{0x65735546, "FUSE"},     Kind{0x19830326, "BeeGFS"}, Kind{0x00C36400, "Ceph"},
    Kind{0x5346414F, "AFS"},      Kind{0x6B414653, "AFS"},    Kind{0xAAD7AAEA, "PanFS"},
    Kind{0x20030528, "OrangeFS"}, Kind{0x01021997, "9P"},     Kind{0x73757245, "Coda"},
    Kind{0x7461636F, "OCFS2"},    Kind{0x01161970, "GFS2"},   Kind{0x564C, "NCP"},
    Kind{0x786F4256, "vboxsf"},
};

}  // namespace

std::string_view NetworkFileSystemName(unsigned long type) {
  // f_type is signed on some architectures: the upper half of a negative one is all ones.
  const unsigned long magic = type & 0xFFFFFFFFUL;
  const auto* const found = std::find_if(kKinds.begin(), kKinds.end(),
                                         [&](const Kind& kind) { return kind.type == magic; });
  return found == kKinds.end() ? "" : found->name;
}

std::string_view NetworkFileSystemOf(const std::filesystem::path& path) {
  struct statfs about {};
  const std::filesystem::path there = path.empty() ? "." : path;
  if (::statfs(there.c_str(), &about) != 0) return "";
  return NetworkFileSystemName(static_cast<unsigned long>(about.f_type));
}

}  // namespace rift::files
