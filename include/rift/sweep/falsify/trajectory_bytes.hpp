#pragma once

#include "rift/sweep/run/byte_codec.hpp"
#include "rift/trajectory/trajectory.hpp"

/// What ByteWriter and ByteReader take of a path.
namespace rift::sweep {

template <class Bytes, Is<trajectory::Channel> T>
void Members(Bytes& bytes, T& channel) {
  bytes(channel.name);
  bytes(channel.values);
}

template <class Bytes, Is<trajectory::Trajectory> T>
void Members(Bytes& bytes, T& path) {
  bytes(path.poses);
  bytes(path.channels);
}

}  // namespace rift::sweep
