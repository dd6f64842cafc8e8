#include "rift/vision/camera/camera_file.hpp"

#include <fmt/format.h>

#include <fmt/ranges.h>
#include <algorithm>
#include <initializer_list>
#include <limits>
#include <vector>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"

namespace rift::vision {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr std::string_view kDirective = "%YAML";

/// Where the comment lines at the head of a file end, its directive and its "---" among them.
std::size_t EndOfHead(std::string_view text) {
  std::size_t end = 0;
  while (end < text.size()) {
    const std::string_view line = text.substr(end, text.find('\n', end) - end);
    if (!line.starts_with('#') && !line.starts_with(kDirective) && line != "---") break;
    end = std::min(end + line.size() + 1, text.size());
  }
  return end;
}

// OpenCV writes a directive and tags that are no YAML of today; blanks keep every column.
std::string WithoutOpenCvTags(std::string_view text) {
  std::string plain(text);
  const std::size_t directive = plain.find(kDirective);
  if (directive < EndOfHead(text)) plain[directive] = '#';
  constexpr std::string_view kTag = "!!opencv-matrix";
  for (std::size_t at = 0; (at = plain.find(kTag, at)) != std::string::npos;) {
    plain.replace(at, kTag.size(), kTag.size(), ' ');
  }
  return plain;
}

using Keys = std::initializer_list<std::string_view>;

const yaml::Node::Entry* FindAny(const yaml::Node& map, Keys keys) {
  for (const std::string_view key : keys) {
    if (const yaml::Node::Entry* entry = map.Find(key)) return entry;
  }
  return nullptr;
}

const yaml::Node::Entry& Require(const yaml::Node& map, Keys keys, const char* what) {
  if (const yaml::Node::Entry* entry = FindAny(map, keys)) return *entry;
  throw yaml::Error(
      fmt::format("{}: no {}: a camera file has the key '{}' (rift track --calibrate makes "
                  "one)",
                  map.origin.source, what, *keys.begin()));
}

double Number(const yaml::Node& node, const std::string& key) {
  return ReadDouble(node, {key, yaml::Range{-kInfinity, kInfinity}, "a number"});
}

void Append(const yaml::Node& node, const std::string& key, std::vector<double>& out) {
  if (!node.IsList()) {
    out.push_back(Number(node, key));
    return;
  }
  for (const yaml::Node& item : node.items) Append(item, key, out);
}

/// {rows, cols, data: [...]}, or lists in lists.
std::vector<double> Matrix(const yaml::Node::Entry& entry) {
  std::vector<double> values;
  if (!entry.value.IsMap()) {
    Append(entry.value, entry.key, values);
    return values;
  }
  const yaml::Node::Entry* data = entry.value.Find("data");
  if (data == nullptr) yaml::Fail(entry.value, entry.key, "a matrix needs rows, cols and data");
  Append(data->value, entry.key + ".data", values);
  std::size_t size = 1;
  for (const char* side : {"rows", "cols"}) {
    const yaml::Node::Entry* count = entry.value.Find(side);
    if (count == nullptr) continue;
    size *= static_cast<std::size_t>(
        ReadInt(count->value, {entry.key + "." + side, yaml::Range{0, 100}, "a count"}));
  }
  const bool has_both = entry.value.Find("rows") && entry.value.Find("cols");
  if (has_both && size != values.size()) {
    yaml::Fail(data->value, entry.key + ".data", fmt::format("rows and cols say {} numbers", size));
  }
  return values;
}

/// In the message that ROS sends, as in its file under other names.
void ReadSize(const yaml::Node& root, CameraModel& camera) {
  const yaml::Node::Entry* width = FindAny(root, {"image_width", "width"});
  const yaml::Node::Entry* height = FindAny(root, {"image_height", "height"});
  const auto read = [](const yaml::Node::Entry& entry) {
    return ReadInt(entry.value, {entry.key, yaml::Range{1, 100'000}, "pixels"});
  };
  if (width != nullptr) camera.width_px = read(*width);
  if (height != nullptr) camera.height_px = read(*height);
}

void ReadMatrix(const yaml::Node& root, CameraModel& camera) {
  const yaml::Node::Entry& entry = Require(root, {"camera_matrix", "K", "mtx"}, "camera matrix");
  const std::vector<double> values = Matrix(entry);
  if (values.size() != 9) yaml::Fail(entry.value, entry.key, "9 numbers, row by row");
  for (int i = 0; i < 9; ++i) camera.k(i / 3, i % 3) = values[static_cast<std::size_t>(i)];
  const yaml::Node::Entry* data = entry.value.IsMap() ? entry.value.Find("data") : &entry;
  const std::string key = data == &entry ? entry.key : entry.key + ".data";
  // OpenCV's projection passes over a skew, so that the poses would be of another camera.
  const bool is_camera = camera.k(0, 0) > 0.0 && camera.k(1, 1) > 0.0 && camera.k(2, 2) == 1.0 &&
                         camera.k(0, 1) == 0.0 && camera.k(1, 0) == 0.0 && camera.k(2, 0) == 0.0 &&
                         camera.k(2, 1) == 0.0;
  if (!is_camera) {
    yaml::Fail(data->value, key,
               fmt::format("[fx, 0, cx, 0, fy, cy, 0, 0, 1] with fx and fy above 0 and no skew, "
                           "not [{}]",
                           fmt::join(values, ", ")));
  }
  if (const auto why = WhyNoLens(camera)) yaml::Fail(data->value, key, *why);
}

Lens ReadLens(const yaml::Node& root) {
  const yaml::Node::Entry* model = root.Find("distortion_model");
  if (model == nullptr) {
    const yaml::Node::Entry* fisheye = root.Find("fisheye_model");
    const bool is_fisheye =
        fisheye != nullptr && (fisheye->value.text == "1" || fisheye->value.text == "true");
    return is_fisheye ? Lens::kEquidistant : Lens::kPlumbBob;
  }
  const std::string& name = model->value.text;
  if (name == "plumb_bob" || name == "rational_polynomial") return Lens::kPlumbBob;
  if (name == "equidistant" || name == "fisheye") return Lens::kEquidistant;
  yaml::Fail(model->value, model->key, "one of plumb_bob, rational_polynomial, equidistant");
}

void ReadDistortion(const yaml::Node& root, CameraModel& camera) {
  camera.lens = ReadLens(root);
  const yaml::Node::Entry& entry = Require(
      root, {"distortion_coefficients", "dist_coeff", "dist_coeffs", "dist", "D"}, "distortion");
  camera.distortion = Matrix(entry);
  const std::size_t count = camera.distortion.size();
  if (camera.lens == Lens::kEquidistant) {
    if (count != 4) yaml::Fail(entry.value, entry.key, "4 numbers: k1 k2 k3 k4 of a fisheye lens");
  } else if (count != 4 && count != 5 && count != 8) {
    yaml::Fail(entry.value, entry.key, "4, 5 or 8 numbers: k1 k2 p1 p2 [k3 [k4 k5 k6]]");
  }
}

/// A reference tag of a world frame as it is written.
struct MarkBlock {
  int id = 0;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0, u_px = 0.0, v_px = 0.0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("id", self.id, 0, kLastTagId, "of the tag");
    field("x_m", self.x_m, -1e3, 1e3, "middle of the tag in the world");
    field("y_m", self.y_m, -1e3, 1e3, "middle of the tag in the world");
    field("z_m", self.z_m, -1e3, 1e3, "middle of the tag in the world");
    field("u_px", self.u_px, -1e6, 1e6, "where it was seen");
    field("v_px", self.v_px, -1e6, 1e6, "where it was seen");
  }
};

struct WorldBlock {
  std::string origin;
  double residual_m = 0.0;
  std::vector<double> world_from_camera;
  std::vector<MarkBlock> tags;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("origin", self.origin, "what set it");
    field("residual_m", self.residual_m, 0.0, 1e3, "RMS on the floor");
    field("world_from_camera", self.world_from_camera, -1e6, 1e6, "4 x 4, row by row");
    field("tags", self.tags, "the reference tags that set it");
  }
};

WorldFrame WorldOf(const yaml::Node::Entry& entry) {
  WorldBlock block;
  yaml::Bind(entry.value, block);
  if (block.world_from_camera.size() != 16) {
    yaml::Fail(entry.value, entry.key + ".world_from_camera", "16 numbers, 4 x 4 row by row");
  }
  WorldFrame world{.residual_m = block.residual_m, .origin = block.origin};
  for (int i = 0; i < 16; ++i) {
    world.world_from_camera.matrix()(i / 4, i % 4) =
        block.world_from_camera[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d turn = world.world_from_camera.linear();
  if (!(turn * turn.transpose()).isIdentity(1e-6) || turn.determinant() < 0.0) {
    yaml::Fail(entry.value, entry.key + ".world_from_camera",
               "must be a rotation and a translation: 16 numbers, row by row");
  }
  for (const MarkBlock& tag : block.tags) {
    world.marks.push_back({tag.id, {tag.x_m, tag.y_m, tag.z_m}, {tag.u_px, tag.v_px}});
  }
  return world;
}

yaml::Node Numbers(const double* first, std::size_t count) {
  yaml::Node list = yaml::Node::List();
  for (std::size_t i = 0; i < count; ++i)
    list.items.push_back(yaml::Node::Scalar(yaml::NumberText(first[i])));
  return list;
}

yaml::Node MatrixNode(int rows, int columns, const yaml::Node& data) {
  yaml::Node map = yaml::Node::Map();
  map.Add("rows", yaml::Node::Scalar(std::to_string(rows)));
  map.Add("cols", yaml::Node::Scalar(std::to_string(columns)));
  map.Add("dt", yaml::Node::Text("d"));  // OpenCV: doubles; the readers of ROS pass over it
  map.Add("data", data);
  return map;
}

template <int Rows, int Columns>
yaml::Node MatrixNode(const Eigen::Matrix<double, Rows, Columns>& matrix) {
  const Eigen::Matrix<double, Columns, Rows> by_rows = matrix.transpose();
  return MatrixNode(Rows, Columns, Numbers(by_rows.data(), Rows * Columns));
}

/// cv::FileStorage takes a text that begins with a digit for a number.
std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

/// Written by hand: cv::FileStorage reads maps in lists only between braces.
std::string WorldText(const WorldFrame& world) {
  std::vector<std::string> numbers;
  for (int i = 0; i < 16; ++i) {
    numbers.push_back(yaml::NumberText(world.world_from_camera.matrix()(i / 4, i % 4)));
  }
  std::string text = fmt::format(
      "world_frame:\n  origin: {}\n  residual_m: {}\n  world_from_camera: [{}]\n",
      Quoted(world.origin), yaml::NumberText(world.residual_m), fmt::join(numbers, ", "));
  if (!world.marks.empty()) text += "  tags:\n";
  for (const ReferenceMark& mark : world.marks) {
    const Eigen::Vector3d& p = mark.p_in_world;
    text += fmt::format("    - {{ id: {}, x_m: {}, y_m: {}, z_m: {}, u_px: {}, v_px: {} }}\n",
                        mark.tag_id, yaml::NumberText(p.x()), yaml::NumberText(p.y()),
                        yaml::NumberText(p.z()), yaml::NumberText(mark.seen_px.x()),
                        yaml::NumberText(mark.seen_px.y()));
  }
  return text;
}

std::string_view ModelName(const CameraModel& camera) {
  if (camera.lens == Lens::kEquidistant) return "equidistant";
  return camera.distortion.size() > 5 ? "rational_polynomial" : "plumb_bob";
}

}  // namespace

CameraModel ReadCamera(std::string_view text, const std::string& source) {
  const yaml::Node root = yaml::Parse(WithoutOpenCvTags(text), source);
  if (!root.IsMap())
    throw yaml::Error(
        fmt::format("{}: this is no camera file (rift track --calibrate makes one)", source));
  CameraModel camera;
  if (const yaml::Node::Entry* name = root.Find("camera_name")) camera.name = name->value.text;
  ReadSize(root, camera);
  ReadMatrix(root, camera);
  ReadDistortion(root, camera);
  const yaml::Node::Entry* own = root.Find("calibration");
  if (own != nullptr && own->value.Find("rms_px") != nullptr) {
    camera.rms_px = Number(own->value.Find("rms_px")->value, "calibration.rms_px");
  } else if (const yaml::Node::Entry* error = root.Find("avg_reprojection_error")) {
    camera.rms_px = Number(error->value, error->key);
  }
  if (const yaml::Node::Entry* world = root.Find("world_frame")) camera.world = WorldOf(*world);
  return camera;
}

std::string CommentOfCamera(std::string_view text) {
  std::string comment;
  const std::string_view head = text.substr(0, EndOfHead(text));
  for (std::size_t at = 0; at < head.size();) {
    const std::size_t end = std::min(head.find('\n', at), head.size() - 1) + 1;
    if (head[at] == '#') comment += head.substr(at, end - at);
    at = end;
  }
  return comment;
}

std::string WriteCamera(const CameraModel& camera, const std::string& comment) {
  yaml::Node root = yaml::Node::Map();
  root.Add("camera_matrix", MatrixNode<3, 3>(camera.k));
  root.Add("distortion_model", yaml::Node::Text(std::string(ModelName(camera))));
  root.Add("distortion_coefficients",
           MatrixNode(1, static_cast<int>(camera.distortion.size()),
                      Numbers(camera.distortion.data(), camera.distortion.size())));
  root.Add("rectification_matrix", MatrixNode<3, 3>(Eigen::Matrix3d::Identity()));
  Eigen::Matrix<double, 3, 4> projection = Eigen::Matrix<double, 3, 4>::Zero();
  projection.leftCols<3>() = camera.k;
  root.Add("projection_matrix", MatrixNode<3, 4>(projection));
  yaml::Node own = yaml::Node::Map();
  own.Add("rms_px", yaml::Node::Scalar(yaml::NumberText(camera.rms_px)));
  root.Add("calibration", own);
  // OpenCV tells YAML by its first bytes, and takes no comment before them.
  return fmt::format("%YAML 1.1\n---\n{}image_width: {}\nimage_height: {}\ncamera_name: {}\n{}{}",
                     comment, camera.width_px, camera.height_px, Quoted(camera.name),
                     yaml::Emit(root), camera.world ? WorldText(*camera.world) : "");
}

}  // namespace rift::vision
