// A camera for LD_PRELOAD: answers open() of /dev/video0 with a memfd and the V4L2 ioctls on it, so
// that OpenCV's V4L2 back end and the kernel's structures are used for real. What it shows and how
// it fails is said by the environment:
//   RIFT_SHIM_FPS      what it delivers, if not what S_PARM asked for
//   RIFT_SHIM_FORMATS  "MJPG,YUYV" (default), "H264", ...
//   RIFT_SHIM_JPEGS    folder of the JPEGs that it cycles through as MJPG
//   RIFT_SHIM_FAULT    unplug (ENODEV), eio, hang, freeze, black, busy (EBUSY), denied (EACCES),
//                      headless (of five JPEGs four come without their begin), torn (all do),
//                      taken (open() answers EBUSY), metadata (the device of the camera that gives
//                      none but metadata), screen (an output, told in the older way)
//   RIFT_SHIM_AFTER    pictures before the fault (default 20)
//   RIFT_SHIM_STAMPS   seconds by which it stamps pictures late (default 0)
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace {

constexpr double kTransfer_s = 0.012;  // from the light to the buffer, as a USB camera has it
constexpr int kMostBuffers = 8;

std::string Env(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr && *value != '\0' ? value : otherwise;
}

double Now_s() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void SleepUntil(double time_s) {
  while (Now_s() < time_s) usleep(500);
}

/// One opening of the device.
struct Device {
  std::uint32_t format = V4L2_PIX_FMT_YUYV;
  std::uint32_t width = 640, height = 480;
  double fps = 30.0;
  int buffers = 0;
  std::vector<int> queued;
  std::uint8_t* memory = nullptr;
  double started_s = 0.0;
  long next_frame = 0;

  std::size_t BufferSize() const {
    const std::size_t raw = std::size_t{2} * width * height;
    return (raw + 4095) / 4096 * 4096;
  }
};

struct Camera {
  std::mutex mutex;
  std::map<int, Device> openings;
  std::string fault = Env("RIFT_SHIM_FAULT", "");
  long fault_after = std::atol(Env("RIFT_SHIM_AFTER", "20").c_str());
  double stamps_late_s = std::atof(Env("RIFT_SHIM_STAMPS", "0").c_str());
  std::vector<std::uint32_t> formats;
  std::vector<std::vector<std::uint8_t>> jpegs;
  long delivered = 0;

  bool FaultIs(const char* name) const { return fault == name && delivered >= fault_after; }
};

Camera& TheCamera() {
  static Camera* camera = [] {
    auto* made = new Camera;
    const std::string list = Env("RIFT_SHIM_FORMATS", "MJPG,YUYV");
    for (std::size_t at = 0; at + 4 <= list.size(); at += 5) {
      made->formats.push_back(v4l2_fourcc(list[at], list[at + 1], list[at + 2], list[at + 3]));
    }
    std::vector<std::filesystem::path> files;
    if (const std::string folder = Env("RIFT_SHIM_JPEGS", ""); !folder.empty()) {
      for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".jpg") files.push_back(entry.path());
      }
    }
    std::sort(files.begin(), files.end());
    for (const auto& path : files) {
      std::ifstream file(path, std::ios::binary);
      made->jpegs.emplace_back(std::istreambuf_iterator<char>(file),
                               std::istreambuf_iterator<char>());
    }
    return made;
  }();
  return *camera;
}

int Error(int number) {
  errno = number;
  return -1;
}

// A comment segment with the number makes each JPEG differ, as a sensor's noise would.
std::size_t PutJpeg(const Camera& camera, std::uint8_t* out, long frame) {
  const std::vector<std::uint8_t>& jpeg =
      camera.jpegs[static_cast<std::size_t>(frame) % camera.jpegs.size()];
  const std::uint8_t comment[8] = {0xFF,
                                   0xFE,
                                   0,
                                   6,
                                   std::uint8_t(frame >> 24),
                                   std::uint8_t(frame >> 16),
                                   std::uint8_t(frame >> 8),
                                   std::uint8_t(frame)};
  std::memcpy(out, jpeg.data(), 2);
  std::memcpy(out + 2, comment, sizeof comment);
  std::memcpy(out + 2 + sizeof comment, jpeg.data() + 2, jpeg.size() - 2);
  return jpeg.size() + sizeof comment;
}

std::size_t PutYuyv(const Device& device, std::uint8_t* out, long frame, bool black) {
  const std::size_t size = std::size_t{2} * device.width * device.height;
  for (std::size_t i = 0; i < size; i += 2) {
    const auto column = static_cast<long>(i / 2 % device.width);
    out[i] = black ? std::uint8_t(16 + (column + frame) % 3) : std::uint8_t(column + 3 * frame);
    out[i + 1] = 128;
  }
  return size;
}

/// What a lost packet leaves of a JPEG.
std::size_t WithoutBegin(std::uint8_t* out, std::size_t size) {
  constexpr std::size_t kLost = 512;
  std::memmove(out, out + kLost, size - kLost);
  return size - kLost;
}

std::size_t PutPicture(const Camera& camera, const Device& device, std::uint8_t* out, long frame) {
  if (camera.FaultIs("freeze")) frame = camera.fault_after;
  if (device.format != V4L2_PIX_FMT_MJPEG) {
    return PutYuyv(device, out, frame, camera.FaultIs("black"));
  }
  const std::size_t size = PutJpeg(camera, out, frame);
  const bool is_headless = camera.FaultIs("headless") && camera.delivered % 5 != 0;
  return is_headless || camera.FaultIs("torn") ? WithoutBegin(out, size) : size;
}

int Capabilities(const Camera& camera, v4l2_capability& out) {
  std::memcpy(out.driver, "shim", 5);
  std::memcpy(out.card, "Shim camera", 12);
  out.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING | V4L2_CAP_DEVICE_CAPS;
  out.device_caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  if (camera.fault == "metadata") out.device_caps = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING;
  if (camera.fault == "screen") {
    // Without the flag device_caps has no meaning.
    out.capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  }
  return 0;
}

int Format(const Camera& camera, Device& device, v4l2_format& format, bool set) {
  v4l2_pix_format& pixels = format.fmt.pix;
  const auto& known = camera.formats;
  if (set) {
    const bool offered = std::find(known.begin(), known.end(), pixels.pixelformat) != known.end();
    device.format = offered ? pixels.pixelformat : known.front();
    device.width = std::clamp(pixels.width, 16U, 1920U);
    device.height = std::clamp(pixels.height, 16U, 1080U);
  }
  pixels.pixelformat = device.format;
  pixels.width = device.width;
  pixels.height = device.height;
  pixels.field = V4L2_FIELD_NONE;
  pixels.bytesperline = 2 * device.width;
  pixels.sizeimage = static_cast<std::uint32_t>(device.BufferSize());
  return 0;
}

int Parameters(Device& device, v4l2_streamparm& parameters, bool set) {
  v4l2_captureparm& capture = parameters.parm.capture;
  if (set && capture.timeperframe.numerator > 0) {
    device.fps = double(capture.timeperframe.denominator) / capture.timeperframe.numerator;
  }
  const std::string forced = Env("RIFT_SHIM_FPS", "");
  if (!forced.empty()) device.fps = std::atof(forced.c_str());
  capture.capability = V4L2_CAP_TIMEPERFRAME;
  capture.timeperframe = {1000, static_cast<std::uint32_t>(1000.0 * device.fps)};
  return 0;
}

int RequestBuffers(const Camera& camera, Device& device, int descriptor,
                   v4l2_requestbuffers& request) {
  if (camera.fault == "busy") return Error(EBUSY);
  if (request.memory != V4L2_MEMORY_MMAP) return Error(EINVAL);
  if (device.memory != nullptr) munmap(device.memory, device.BufferSize() * device.buffers);
  device.memory = nullptr;
  device.queued.clear();
  device.buffers = std::min<int>(static_cast<int>(request.count), kMostBuffers);
  request.count = static_cast<std::uint32_t>(device.buffers);
  if (device.buffers == 0) return 0;
  const std::size_t size = device.BufferSize() * device.buffers;
  if (ftruncate(descriptor, static_cast<off_t>(size)) != 0) return -1;
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  device.memory = memory == MAP_FAILED ? nullptr : static_cast<std::uint8_t*>(memory);
  return device.memory == nullptr ? -1 : 0;
}

int QueryBuffer(const Device& device, v4l2_buffer& buffer) {
  if (buffer.index >= static_cast<std::uint32_t>(device.buffers)) return Error(EINVAL);
  buffer.length = static_cast<std::uint32_t>(device.BufferSize());
  buffer.m.offset = static_cast<std::uint32_t>(buffer.index * device.BufferSize());
  return 0;
}

// Pictures that nobody asked for in time are lost but for as many as there are buffers.
long NextFrame(const Device& device) {
  const long now = static_cast<long>((Now_s() - device.started_s) * device.fps);
  return std::max(device.next_frame, now - static_cast<long>(device.queued.size()) + 1);
}

int Dequeue(Camera& camera, Device& device, v4l2_buffer& buffer) {
  if (device.queued.empty()) return Error(EAGAIN);
  if (camera.FaultIs("unplug")) return Error(ENODEV);
  if (camera.FaultIs("eio")) return Error(EIO);
  if (camera.FaultIs("hang")) {
    camera.mutex.unlock();
    for (;;) pause();
  }
  const long frame = NextFrame(device);
  const double light_s = device.started_s + static_cast<double>(frame + 1) / device.fps;
  camera.mutex.unlock();
  SleepUntil(light_s + kTransfer_s);
  camera.mutex.lock();
  device.next_frame = frame + 1;
  const int index = device.queued.front();
  device.queued.erase(device.queued.begin());
  buffer.index = static_cast<std::uint32_t>(index);
  buffer.bytesused = static_cast<std::uint32_t>(
      PutPicture(camera, device, device.memory + index * device.BufferSize(), frame));
  buffer.length = static_cast<std::uint32_t>(device.BufferSize());
  buffer.m.offset = static_cast<std::uint32_t>(index * device.BufferSize());
  buffer.flags = V4L2_BUF_FLAG_MAPPED | V4L2_BUF_FLAG_DONE | V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  buffer.sequence = static_cast<std::uint32_t>(frame);
  const double stamp_s = light_s + camera.stamps_late_s;
  buffer.timestamp.tv_sec = static_cast<time_t>(std::floor(stamp_s));
  buffer.timestamp.tv_usec = static_cast<suseconds_t>((stamp_s - std::floor(stamp_s)) * 1e6);
  ++camera.delivered;
  return 0;
}

int Describe(const Camera& camera, v4l2_fmtdesc& format) {
  if (format.index >= camera.formats.size()) return Error(EINVAL);
  format.pixelformat = camera.formats[format.index];
  return 0;
}

template <class T>
T& As(void* argument) {
  return *static_cast<T*>(argument);
}

int Answer(Camera& camera, int descriptor, Device& device, unsigned long request, void* argument) {
  if (camera.FaultIs("unplug")) return Error(ENODEV);
  switch (request) {
    case VIDIOC_QUERYCAP:
      return Capabilities(camera, As<v4l2_capability>(argument));
    case VIDIOC_ENUM_FMT:
      return Describe(camera, As<v4l2_fmtdesc>(argument));
    case VIDIOC_G_FMT:
      return Format(camera, device, As<v4l2_format>(argument), false);
    case VIDIOC_TRY_FMT:
    case VIDIOC_S_FMT:
      return Format(camera, device, As<v4l2_format>(argument), true);
    case VIDIOC_G_PARM:
      return Parameters(device, As<v4l2_streamparm>(argument), false);
    case VIDIOC_S_PARM:
      return Parameters(device, As<v4l2_streamparm>(argument), true);
    case VIDIOC_G_INPUT:
      As<int>(argument) = 0;
      return 0;
    case VIDIOC_S_INPUT:
      return 0;
    case VIDIOC_ENUMINPUT:
      return As<v4l2_input>(argument).index == 0 ? 0 : Error(EINVAL);
    case VIDIOC_REQBUFS:
      return RequestBuffers(camera, device, descriptor, As<v4l2_requestbuffers>(argument));
    case VIDIOC_QUERYBUF:
      return QueryBuffer(device, As<v4l2_buffer>(argument));
    case VIDIOC_QBUF:
      device.queued.push_back(static_cast<int>(As<v4l2_buffer>(argument).index));
      return 0;
    case VIDIOC_DQBUF:
      return Dequeue(camera, device, As<v4l2_buffer>(argument));
    case VIDIOC_STREAMON:
      device.started_s = Now_s();
      device.next_frame = 0;
      return 0;
    case VIDIOC_STREAMOFF:
      device.queued.clear();
      return 0;
    default:
      return Error(EINVAL);
  }
}

using OpenFunction = int (*)(const char*, int, ...);

int Open(const char* real_name, const char* path, int flags, mode_t mode) {
  if (std::strcmp(path, "/dev/video0") != 0) {
    static const auto real = reinterpret_cast<OpenFunction>(dlsym(RTLD_NEXT, real_name));
    return real(path, flags, mode);
  }
  Camera& camera = TheCamera();
  const std::lock_guard lock(camera.mutex);
  if (camera.fault == "denied") return Error(EACCES);
  if (camera.fault == "taken") return Error(EBUSY);
  const int descriptor = memfd_create("shim camera", MFD_CLOEXEC);
  camera.openings[descriptor] = {};
  return descriptor;
}

mode_t ModeOf(int flags, va_list words) {
  return (flags & O_CREAT) != 0 ? va_arg(words, mode_t) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list words;
  va_start(words, flags);
  const mode_t mode = ModeOf(flags, words);
  va_end(words);
  return Open("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list words;
  va_start(words, flags);
  const mode_t mode = ModeOf(flags, words);
  va_end(words);
  return Open("open64", path, flags, mode);
}

int __open_2(const char* path, int flags) { return Open("open", path, flags, 0); }
int __open64_2(const char* path, int flags) { return Open("open64", path, flags, 0); }

int close(int descriptor) {
  static const auto real = reinterpret_cast<int (*)(int)>(dlsym(RTLD_NEXT, "close"));
  {
    Camera& camera = TheCamera();
    const std::lock_guard lock(camera.mutex);
    camera.openings.erase(descriptor);
  }
  return real(descriptor);
}

int ioctl(int descriptor, unsigned long request, ...) {
  using Ioctl = int (*)(int, unsigned long, ...);
  static const auto real = reinterpret_cast<Ioctl>(dlsym(RTLD_NEXT, "ioctl"));
  va_list words;
  va_start(words, request);
  void* argument = va_arg(words, void*);
  va_end(words);
  Camera& camera = TheCamera();
  std::unique_lock lock(camera.mutex);
  const auto opening = camera.openings.find(descriptor);
  if (opening == camera.openings.end()) {
    lock.unlock();
    return real(descriptor, request, argument);
  }
  return Answer(camera, descriptor, opening->second, request, argument);
}
}
