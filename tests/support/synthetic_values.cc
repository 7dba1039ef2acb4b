#include "tests/support/synthetic_values.h"

#include <cmath>
#include <memory>
#include <type_traits>

namespace vs::test {
namespace {

struct Size {
  int width;
  int height;
};
constexpr Size kSizes[] = {{64, 48}, {7, 5}, {1, 1}};

BufferPool& Pool() {
  static BufferPool pool;
  return pool;
}

GreyImage Picture(Size size, int shift) {
  GreyImage image(Pool(), size.width, size.height);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      image.Row(y)[x] = static_cast<uint8_t>(((x + shift) * 2654435761u + y * 40503u) >> 7);
    }
  }
  return image;
}

RectifiedGeometry Geometry(Size size) {
  return {size.width, size.height, 600, 0.06, size.width / 2.0, size.height / 2.0, 0};
}

std::shared_ptr<const Frame> Camera(Size size, int shift) {
  Frame frame;
  frame.image = Picture(size, shift);
  frame.camera = shift == 0 ? "left" : "right";
  frame.number = 3;
  frame.capture_ns = 1'000'000;
  frame.arrival_ns = 2'000'000;
  return std::make_shared<const Frame>(frame);
}

std::shared_ptr<const StereoTruth> Truth(Size size) {
  StereoTruth truth{Image<float>(Pool(), size.width, size.height),
                    GreyImage(Pool(), size.width, size.height)};
  truth.disparity_px.Fill(4.25F);
  truth.disparity_px.Row(0)[0] = std::nanf("");
  truth.visible.Fill(255);
  return std::make_shared<const StereoTruth>(truth);
}

std::shared_ptr<const DisparityMap> Disparity(Size size, uint16_t value) {
  const auto reason = value == kInvalidDisparity ? InvalidReason::kOccluded : InvalidReason::kNone;
  DisparityMap map{Image<uint16_t>(Pool(), size.width, size.height),
                   GreyImage(Pool(), size.width, size.height),
                   GreyImage(Pool(), size.width, size.height), 0, Geometry(size)};
  map.disparity.Fill(value);
  map.confidence.Fill(value == kInvalidDisparity ? 0 : 200);
  map.reason.Fill(static_cast<uint8_t>(reason));
  return std::make_shared<const DisparityMap>(map);
}

std::shared_ptr<const DepthMap> Depth(Size size, float depth_m) {
  DepthMap map{Image<float>(Pool(), size.width, size.height), Geometry(size)};
  map.depth_m.Fill(depth_m);
  return std::make_shared<const DepthMap>(map);
}

std::shared_ptr<const PointCloud> Cloud(Size size, float z_m) {
  PointCloud cloud{Image<float>(Pool(), size.width, size.height),
                   Image<float>(Pool(), size.width, size.height),
                   Image<float>(Pool(), size.width, size.height), Geometry(size)};
  cloud.x_m.Fill(z_m / 4);
  cloud.y_m.Fill(z_m / 8);
  cloud.z_m.Fill(z_m);
  return std::make_shared<const PointCloud>(cloud);
}

std::shared_ptr<const StereoRig> Rig() {
  StereoRig rig;
  rig.name = "synthetic";
  rig.left = {64, 48, 60, 60, 31.5, 23.5};
  rig.right = rig.left;
  rig.right_from_left_translation_m = {-0.06, 0, 0};
  return std::make_shared<const StereoRig>(rig);
}

template <class T, class Make>
std::vector<Value> ForEachSize(const Make& make) {
  std::vector<Value> values;
  for (const Size& size : kSizes) values.push_back(std::make_shared<const T>(make(size)));
  return values;
}

std::vector<Value> StereoFrames() {
  std::vector<Value> values;
  for (const Size& size : kSizes) {
    StereoFrame raw{Camera(size, 0), Camera(size, 4), 3, 1000, {}, nullptr};
    StereoFrame rectified = raw;
    rectified.geometry = Geometry(size);
    rectified.truth = Truth(size);
    values.push_back(std::make_shared<const StereoFrame>(raw));
    values.push_back(std::make_shared<const StereoFrame>(rectified));
  }
  return values;
}

class Hash {
 public:
  void Bytes(const void* bytes, size_t count) {
    for (size_t i = 0; i < count; ++i) {
      value_ = (value_ ^ static_cast<const unsigned char*>(bytes)[i]) * 0x100000001b3;
    }
  }
  template <class T>
  void Add(const T& plain) {
    static_assert(std::is_trivially_copyable_v<T>);
    Bytes(&plain, sizeof plain);
  }
  template <class T>
  void Add(const Image<T>& image) {
    Add(image.width());
    for (int y = 0; y < image.height(); ++y) Bytes(image.Row(y), image.width() * sizeof(T));
  }
  void Add(const std::string& text) { Bytes(text.data(), text.size()); }
  void Add(const Frame& frame) {
    Add(frame.image);
    Add(frame.number);
    Add(frame.capture_ns);
  }
  void Add(const StereoTruth& truth) {
    Add(truth.disparity_px);
    Add(truth.visible);
  }
  void Add(const StereoFrame& frame) {
    Add(*frame.left);
    Add(*frame.right);
    Add(frame.number);
    if (frame.geometry) Add(*frame.geometry);
    if (frame.truth != nullptr) Add(*frame.truth);
  }
  void Add(const DisparityMap& map) {
    Add(map.disparity);
    Add(map.confidence);
    Add(map.reason);
    Add(map.offset_px);
    Add(map.geometry);
  }
  void Add(const DepthMap& map) {
    Add(map.depth_m);
    Add(map.geometry);
  }
  void Add(const PointCloud& cloud) {
    Add(cloud.x_m);
    Add(cloud.y_m);
    Add(cloud.z_m);
    Add(cloud.geometry);
  }
  void Add(const StereoRig& rig) {
    Add(rig.name);
    Add(rig.left);
    Add(rig.right);
    Add(rig.right_from_left_rotation);
    Add(rig.right_from_left_translation_m);
  }
  void Add(const List& list) {
    for (const Value& value : list) Add(value);
  }
  void Add(const Table& table) {
    for (const std::string& column : table.columns) Add(column);
    for (const List& row : table.rows) Add(row);
  }
  void Add(std::monostate) {}
  template <class T>
  void Add(const std::shared_ptr<const T>& shared) {
    Add(*shared);
  }
  void Add(const Value& value) {
    std::visit([this](const auto& held) { Add(held); }, value.variant());
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325;
};

}  // namespace

std::vector<Value> SyntheticValues(std::string_view port_type) {
  if (port_type == "any" || port_type == "number") return {0.5, -1e9, std::nan("")};
  if (port_type == "bool") return {true, false};
  if (port_type == "integer") return {int64_t{3}, int64_t{-1}};
  if (port_type == "string") return {std::string("text"), std::string()};
  if (port_type == "trigger") return {Trigger{5}};
  if (port_type == "list") return {std::make_shared<const List>(List{Value(1.5), Value(true)})};
  if (port_type == "table") {
    return {std::make_shared<const Table>(Table{{"x"}, {{Value(1.5)}, {Value(2.5)}}})};
  }
  if (port_type == "grey_image") {
    return ForEachSize<GreyImage>([](Size size) { return Picture(size, 0); });
  }
  if (port_type == "color_image") {
    return ForEachSize<ColorImage>([](Size size) {
      ColorImage image(Pool(), size.width, size.height);
      image.Fill({10, 20, 30});
      return image;
    });
  }
  if (port_type == "frame") {
    return ForEachSize<Frame>([](Size size) { return *Camera(size, 0); });
  }
  if (port_type == "stereo_frame") return StereoFrames();
  if (port_type == "stereo_truth") {
    return ForEachSize<StereoTruth>([](Size size) { return *Truth(size); });
  }
  if (port_type == "disparity_map") {
    std::vector<Value> values;
    for (const Size& size : kSizes) {
      values.push_back(Disparity(size, 68));
      values.push_back(Disparity(size, kInvalidDisparity));
    }
    return values;
  }
  if (port_type == "depth_map") {
    std::vector<Value> values;
    for (const Size& size : kSizes) {
      values.push_back(Depth(size, 1.25F));
      values.push_back(Depth(size, std::nanf("")));
    }
    return values;
  }
  if (port_type == "point_cloud") {
    std::vector<Value> values;
    for (const Size& size : kSizes) {
      values.push_back(Cloud(size, 1.25F));
      values.push_back(Cloud(size, std::nanf("")));
    }
    return values;
  }
  if (port_type == "stereo_rig") return {Rig()};
  return {};
}

uint64_t HashOf(const Value& value) {
  Hash hash;
  hash.Add(value);
  return hash.value();
}

}  // namespace vs::test
