#include "engine/camera/gev_stream.h"

#include <pthread.h>
#include <sched.h>
#include <sys/socket.h>

#include <algorithm>
#include <ctime>
#include <utility>
#include <vector>

#include "engine/base/mutex.h"
#include "engine/base/str.h"
#include "engine/camera/gev_sockets.h"

namespace vs {
namespace {

constexpr unsigned kPacketTimeoutUs = 5'000;
constexpr unsigned kInitialPacketTimeoutUs = 1'000;
constexpr unsigned kFrameRetentionUs = 200'000;
constexpr int kReceivePriority = 10;

int64_t UtcNs() {
  timespec now{};
  clock_gettime(CLOCK_REALTIME, &now);
  return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

// Receiving must not wait for number crunching. Needs CAP_SYS_NICE; without it all goes on as
// usual.
void OnStreamThread(void* /*user*/, ArvStreamCallbackType type, ArvBuffer* /*buffer*/) {
  if (type != ARV_STREAM_CALLBACK_TYPE_INIT) return;
  sched_param priority{};
  priority.sched_priority = kReceivePriority;
  (void)pthread_setschedparam(pthread_self(), SCHED_RR, &priority);
}

// Aravis 0.8.29 to 0.8.33 calls back through a null pointer when a camera sends an unknown payload.
ArvStreamCallback SafeCallback() {
  const unsigned micro = arv_get_micro_version();
  const bool broken =
      arv_get_major_version() == 0 && arv_get_minor_version() == 8 && micro >= 29 && micro <= 33;
  return broken ? nullptr : OnStreamThread;
}

ArvBuffer* WrapSlab(Buffer slab) {
  auto* owner = new Buffer(std::move(slab));
  return arv_buffer_new_full(owner->size_bytes, owner->data, owner,
                             [](void* user) { delete static_cast<Buffer*>(user); });
}

std::string StatusText(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_TIMEOUT:
    case ARV_BUFFER_STATUS_MISSING_PACKETS:
      return "packets were lost on the network";
    case ARV_BUFFER_STATUS_WRONG_PACKET_ID:
      return "packets had a number that does not belong to the picture";
    case ARV_BUFFER_STATUS_SIZE_MISMATCH:
      return "the picture had another size than the camera announced";
    default:
      return Str("the receiver gave up (status ", static_cast<int>(status), ")");
  }
}

}  // namespace

// Brings a buffer back to the stream when its last reader lets go, or frees it when the stream is
// gone by then: a reader never waits for, or closes, a camera.
class GevStream::ReturnPath {
 public:
  explicit ReturnPath(ArvStream* stream) : stream_(stream) {}

  void Give(ArvBuffer* buffer) {
    // Whatever comes out without being filled again is then known to be stale.
    arv_buffer_set_frame_id(buffer, 0);
    MutexLock lock(mutex_);
    if (stream_ != nullptr) {
      arv_stream_push_buffer(stream_, buffer);
    } else {
      g_object_unref(buffer);
    }
  }

  void Cut() {
    MutexLock lock(mutex_);
    stream_ = nullptr;
  }

 private:
  Mutex mutex_;
  ArvStream* stream_ VS_GUARDED_BY(mutex_);
};

Result<std::unique_ptr<GevStream>> GevStream::Make(ArvDevice* device,
                                                   const GevStreamOptions& options) {
  GlibError error;
  const int64_t payload_bytes =
      arv_device_get_integer_feature_value(device, "PayloadSize", error.out());
  if (error) return error.ToStatus().Annotated("PayloadSize");
  if (payload_bytes <= 0 || payload_bytes > int64_t{1} << 31) {
    return FailedPrecondition(Str("the camera announces pictures of ", payload_bytes, " bytes"));
  }
  arv_gv_device_set_stream_options(ARV_GV_DEVICE(device),
                                   ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  ArvStream* stream = nullptr;
  {
    MutexLock lock(AravisOpensSockets());
    stream = arv_device_create_stream(device, SafeCallback(), nullptr, error.out());
  }
  if (stream == nullptr) return error.ToStatus().Annotated("opening the stream");
  std::unique_ptr<GevStream> made(new GevStream(stream, payload_bytes));
  // The properties are unsigned or int as Aravis declares them.
  g_object_set(stream, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
               options.socket_buffer_bytes, "packet-timeout", kPacketTimeoutUs,
               "initial-packet-timeout", kInitialPacketTimeoutUs, "frame-retention",
               kFrameRetentionUs, nullptr);
  if (!options.resend) {
    g_object_set(stream, "packet-resend", ARV_GV_STREAM_PACKET_RESEND_NEVER, nullptr);
  }
  BufferPool pool;
  for (int i = 0; i < options.buffers; ++i) {
    arv_stream_push_buffer(stream, WrapSlab(pool.Acquire(static_cast<size_t>(payload_bytes))));
  }
  return made;
}

GevStream::GevStream(ArvStream* stream, int64_t payload_bytes)
    : stream_(stream),
      payload_bytes_(payload_bytes),
      return_path_(std::make_shared<ReturnPath>(stream)) {}

GevStream::~GevStream() { return_path_->Cut(); }

std::optional<GevPicture> GevStream::Pop(std::chrono::milliseconds timeout) {
  ArvBuffer* buffer =
      arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(timeout.count()) * 1000);
  if (buffer == nullptr) return std::nullopt;
  GevPicture picture;
  const ArvBufferStatus status = arv_buffer_get_status(buffer);
  picture.frame_id = arv_buffer_get_frame_id(buffer);
  picture.timestamp_ns = static_cast<int64_t>(arv_buffer_get_timestamp(buffer));
  if (status == ARV_BUFFER_STATUS_SUCCESS && picture.frame_id != 0) {
    picture.leader_age_ns = UtcNs() - static_cast<int64_t>(arv_buffer_get_system_timestamp(buffer));
    picture.image = Wrap(buffer);
    if (!picture.image.empty()) {
      picture.kind = GevPicture::Kind::kWhole;
      return picture;
    }
    picture.kind = GevPicture::Kind::kIncomplete;
    picture.problem = "the picture was not 8-bit grey (PixelFormat Mono8)";
  } else if (status == ARV_BUFFER_STATUS_SUCCESS || status == ARV_BUFFER_STATUS_CLEARED) {
    picture.kind = GevPicture::Kind::kRecycled;
  } else if (status != ARV_BUFFER_STATUS_ABORTED) {
    picture.kind = GevPicture::Kind::kIncomplete;
    picture.problem = StatusText(status);
  }
  return_path_->Give(buffer);
  return picture;
}

// The pixels in the buffer; empty when they are not what an image needs, which the camera's packets
// decide and nobody else checked.
GreyImage GevStream::Wrap(ArvBuffer* buffer) {
  size_t size_bytes = 0;
  const void* data = arv_buffer_get_data(buffer, &size_bytes);
  if (arv_buffer_get_payload_type(buffer) != ARV_BUFFER_PAYLOAD_TYPE_IMAGE ||
      arv_buffer_get_image_pixel_format(buffer) != ARV_PIXEL_FORMAT_MONO_8) {
    return {};
  }
  const int width = arv_buffer_get_image_width(buffer);
  const int height = arv_buffer_get_image_height(buffer);
  gint padding_x = 0;
  gint padding_y = 0;
  arv_buffer_get_image_padding(buffer, &padding_x, &padding_y);
  const int64_t stride_bytes = int64_t{width} + padding_x;
  if (data == nullptr || width <= 0 || height <= 0 || padding_x < 0 ||
      stride_bytes * height > static_cast<int64_t>(size_bytes)) {
    return {};
  }
  // Aravis gives the bytes as const; they are our own pool's memory.
  auto* bytes = static_cast<std::byte*>(const_cast<void*>(data));
  std::shared_ptr<const void> owner(
      data, [path = return_path_, buffer](const void*) { path->Give(buffer); }, control_blocks_);
  return GreyImage(Buffer{bytes, size_bytes, Place::kHost, std::move(owner)}, width, height,
                   static_cast<size_t>(stride_bytes));
}

GevStreamCounters GevStream::Counters() const {
  const auto counter = [this](const char* name) {
    return static_cast<uint64_t>(arv_stream_get_info_uint64_by_name(stream_.get(), name));
  };
  return {counter("n_underruns"), counter("n_resend_requests"), counter("n_resent_packets")};
}

int GevStream::SocketBufferBytes() const {
  const std::vector<UdpSocket> sockets = UdpSocketsOfThisProcess();
  const auto own = std::ranges::find(sockets, arv_gv_stream_get_port(ARV_GV_STREAM(stream_.get())),
                                     &UdpSocket::port);
  int bytes = 0;
  socklen_t length = sizeof bytes;
  if (own == sockets.end() || getsockopt(own->fd, SOL_SOCKET, SO_RCVBUF, &bytes, &length) != 0) {
    return 0;
  }
  return bytes / 2;  // the kernel doubles what it grants, for its own bookkeeping
}

}  // namespace vs
