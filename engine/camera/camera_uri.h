#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/status.h"

namespace vs {

// Where a camera is: "scheme:address?key=value&key=value".
//   gev:21000001            GigE Vision camera by serial number
//   gev-ip:192.168.1.20     GigE Vision camera by address
//   sim:demo#left           the simulated scene, one of its two cameras
//   file:run7?pattern=*_left.png&loop=true&fps=30
//                           pictures of a folder: below the server's data folder, or an absolute
//                           path below a picture_root of its configuration
//   camera:left             the camera of this name in the server's configuration
// A key that starts with a capital is a feature of the camera (ExposureTimeAbs=5000), set in the
// written order before it streams; any other key is an option of the driver. A character that would
// be read otherwise ('%' anywhere, '?' in an address, '&' in a value) is written as '%' and two hex
// digits.
struct CameraUri {
  using Options = std::vector<std::pair<std::string, std::string>>;

  std::string scheme;
  std::string address;
  Options options;  // in the written order; a driver's option occurs once

  static Result<CameraUri> Parse(std::string_view text);
  // Parse(ToString()) gives the same camera again.
  std::string ToString() const;

  // The value of an option or feature; nullopt when it is not given.
  std::optional<std::string> Option(std::string_view key) const;
  // The features of the camera that the URI sets, in order.
  Options Features() const;

  bool operator==(const CameraUri&) const = default;
};

// Reads the driver options of a URI, each with its default, and collects what is wrong with them:
//   UriOptions options(uri);
//   const int buffers = options.Integer("buffers", 8, 3, 64);
//   VS_RETURN_IF_ERROR(options.Check());
class UriOptions {
 public:
  explicit UriOptions(const CameraUri& uri) : uri_(uri) {}

  std::string Text(std::string_view key, std::string_view initial);
  bool Flag(std::string_view key, bool initial);
  int64_t Integer(std::string_view key, int64_t initial, int64_t min, int64_t max);
  double Number(std::string_view key, double initial, double min, double max);

  // INVALID_ARGUMENT with every bad value and every option that was not asked for.
  Status Check() const;

 private:
  std::optional<std::string> Take(std::string_view key);
  void Refuse(std::string_view key, const std::string& value, const std::string& expected);

  const CameraUri& uri_;
  std::vector<std::string> known_;
  std::vector<Fault> faults_;
};

}  // namespace vs
