#include "engine/sim/gevsim/registers.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "engine/base/check.h"
#include "engine/sim/gevsim/bytes.h"
#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {
namespace {

// Rows are read out one after the other, which limits the frame rate: 30 a second for 966 rows.
constexpr int64_t kRowReadoutNs = 34'000;

// A run of registers of one kind.
struct Span {
  uint32_t end;  // behind the last byte
  bool readable;
  bool writable;
  uint32_t min = 0;
  uint32_t max = 0xffffffff;
  bool fixed_while_streaming = false;
};

Span ReadOnly(uint32_t end) { return {end, true, false}; }
Span Writable(uint32_t address, uint32_t min = 0, uint32_t max = 0xffffffff) {
  return {address + 4, true, true, min, max};
}
Span Format(uint32_t address, uint32_t min, uint32_t max) {
  return {address + 4, true, true, min, max, true};
}
Span Command(uint32_t address) { return {address + 4, true, true, 0, 1}; }

// Every register there is, by where it begins.
const std::map<uint32_t, Span>& Map() {
  static const std::map<uint32_t, Span> map = [] {
    using namespace reg;  // NOLINT(google-build-using-namespace)
    std::map<uint32_t, Span> made = {
        {kVersion, ReadOnly(kUserName)},
        {kUserName, {kDiscoveryEnd, true, true}},
        {kXmlUrl, ReadOnly(kSecondXmlUrl + 512)},
        {kInterfaceCount, ReadOnly(kInterfaceCount + 4)},
        {kMessageChannelCount, ReadOnly(kActionDeviceKey)},
        {kActionDeviceKey, {kActionDeviceKey + 4, false, true}},
        {kGvcpCapability, ReadOnly(kHeartbeatTimeout)},
        {kHeartbeatTimeout, Writable(kHeartbeatTimeout, 100)},
        {kTickFrequencyHigh, ReadOnly(kTimestampControl)},
        {kTimestampControl, {kTimestampControl + 4, false, true, 0, 3}},
        {kTimestampHigh, ReadOnly(kTimestampLow + 4)},
        {kControlPrivilege, Writable(kControlPrivilege)},
        {kStreamPort, Writable(kStreamPort)},
        {kStreamPacketSize, Writable(kStreamPacketSize)},
        {kStreamPacketDelay, Writable(kStreamPacketDelay)},
        {kStreamDestination, Writable(kStreamDestination)},
        {kStreamSourcePort, ReadOnly(kStreamSourcePort + 4)},
        {kActionGroupKey, Writable(kActionGroupKey)},
        {kActionGroupMask, Writable(kActionGroupMask)},
        {kWidth, Format(kWidth, 1, 0)},
        {kHeight, Format(kHeight, 1, 0)},
        {kOffsetX, Format(kOffsetX, 0, 0)},
        {kOffsetY, Format(kOffsetY, 0, 0)},
        {kBinningX, Format(kBinningX, 1, kMaxBinning)},
        {kBinningY, Format(kBinningY, 1, kMaxBinning)},
        {kPixelFormat, Format(kPixelFormat, kPixelFormatMono8, kPixelFormatMono8)},
        {kSensorWidth, ReadOnly(kPayloadSize + 4)},
        {kAcquisitionMode, Format(kAcquisitionMode, 0, 1)},
        {kAcquisitionStart, Command(kAcquisitionStart)},
        {kAcquisitionStop, Command(kAcquisitionStop)},
        {kAcquisitionActive, ReadOnly(kAcquisitionActive + 4)},
        {kExposureUs, Writable(kExposureUs, static_cast<uint32_t>(kMinExposureUs),
                               static_cast<uint32_t>(kMaxExposureUs))},
        {kExposureAuto, Writable(kExposureAuto, 0, 0)},
        {kGain, Writable(kGain, 0, kMaxGainRaw)},
        {kGainAuto, Writable(kGainAuto, 0, 0)},
        {kBlackLevel, Writable(kBlackLevel, 0, kMaxBlackLevelRaw)},
        {kFramePeriodUs, Writable(kFramePeriodUs, 1000, 10'000'000)},
        {kFrameRateEnable, Writable(kFrameRateEnable, 0, 1)},
        {kResultingPeriodUs, ReadOnly(kResultingPeriodUs + 4)},
        {kTriggerSelector, Writable(kTriggerSelector, 0, 1)},
        {kTriggerSoftware, Command(kTriggerSoftware)},
    };
    for (const uint32_t step : {0u, kTriggerStep}) {
      made[kTriggerMode + step] = Writable(kTriggerMode + step, 0, 1);
      made[kTriggerSource + step] = Writable(kTriggerSource + step, 0, 2);
      made[kTriggerActivation + step] = Writable(kTriggerActivation + step, 0, 1);
    }
    return made;
  }();
  return map;
}

const Span* Find(uint32_t address) {
  auto next = Map().upper_bound(address);
  if (next == Map().begin()) return nullptr;
  --next;
  return address < next->second.end ? &next->second : nullptr;
}

}  // namespace

Registers::Registers(const DeviceIdentity& identity, std::string_view xml)
    : memory_(reg::kXmlBegin + (xml.size() + 3) / 4 * 4) {
  MutexLock lock(mutex_);
  std::copy(xml.begin(), xml.end(), memory_.begin() + reg::kXmlBegin);
  char url[64];
  std::snprintf(url, sizeof url, "Local:camera.xml;%x;%zx", reg::kXmlBegin, xml.size());
  SetText(reg::kXmlUrl, 512, url);
  SetText(reg::kManufacturerName, 32, "Basler");
  SetText(reg::kModelName, 32, "acA1300-30gm");
  SetText(reg::kDeviceVersion, 32, "simulated");
  SetText(reg::kManufacturerInfo, 48, "simulated by gevsim");
  SetText(reg::kSerialNumber, 16, identity.serial_number);
  SetText(reg::kUserName, 16, identity.user_name);
  SetWord(reg::kVersion, 0x00010002);     // GigE Vision 1.2
  SetWord(reg::kDeviceMode, 0x80000001);  // big endian, UTF-8
  // Basler's block of addresses; the rest from the serial number, so that no two are equal.
  SetWord(reg::kMacHigh, 0x0030);
  SetWord(reg::kMacLow, 0x53000000 | (std::hash<std::string>{}(identity.serial_number) & 0xffffff));
  SetWord(reg::kIpOptions, 0x7);
  SetWord(reg::kIpConfiguration, 0x1);
  SetWord(reg::kCurrentAddress, identity.address);
  SetWord(reg::kCurrentSubnetMask, identity.subnet_mask);
  SetWord(reg::kInterfaceCount, 1);
  SetWord(reg::kStreamChannelCount, 1);
  SetWord(reg::kActionSignalCount, 1);
  // User name, serial number, heartbeat; action, resend, write memory, several registers at once.
  SetWord(reg::kGvcpCapability, 0xc0000000 | (1u << 6) | (1u << 2) | (1u << 1) | 1u);
  SetWord(reg::kHeartbeatTimeout, identity.heartbeat_timeout_ms);
  SetWord(reg::kTickFrequencyHigh, static_cast<uint32_t>(identity.tick_hz >> 32));
  SetWord(reg::kTickFrequencyLow, static_cast<uint32_t>(identity.tick_hz));
  SetWord(reg::kStreamPacketSize, 1500);
  SetWord(reg::kSensorWidth, identity.sensor_width);
  SetWord(reg::kSensorHeight, identity.sensor_height);
  SetWord(reg::kBinningX, 1);
  SetWord(reg::kBinningY, 1);
  SetWord(reg::kWidth, identity.sensor_width);
  SetWord(reg::kHeight, identity.sensor_height);
  SetWord(reg::kPixelFormat, kPixelFormatMono8);
  SetWord(reg::kExposureUs, static_cast<uint32_t>(kNominalExposureUs));
  SetWord(reg::kFramePeriodUs, 33'333);
  for (const uint32_t step : {0u, reg::kTriggerStep}) {
    SetWord(reg::kTriggerSource + step, static_cast<uint32_t>(TriggerSource::kLine1));
  }
}

GevStatus Registers::Read(uint32_t address, std::span<uint8_t> bytes) const {
  if (address % 4 != 0) return GevStatus::kBadAlignment;
  MutexLock lock(mutex_);
  if (address >= reg::kXmlBegin) {
    if (address > memory_.size() || bytes.size() > memory_.size() - address) {
      return GevStatus::kInvalidAddress;
    }
    std::copy_n(memory_.begin() + address, bytes.size(), bytes.begin());
    return GevStatus::kSuccess;
  }
  for (size_t i = 0; i < bytes.size(); i += 4) {
    const Span* span = Find(address + static_cast<uint32_t>(i));
    if (span == nullptr) return GevStatus::kInvalidAddress;
    uint8_t word[4];
    PutU32(word, span->readable ? Word(address + static_cast<uint32_t>(i)) : 0);
    std::copy_n(word, std::min<size_t>(4, bytes.size() - i), bytes.begin() + i);
  }
  return GevStatus::kSuccess;
}

GevStatus Registers::Write(uint32_t address, std::span<const uint8_t> bytes) {
  if (address % 4 != 0 || bytes.size() % 4 != 0) return GevStatus::kBadAlignment;
  MutexLock lock(mutex_);
  for (size_t i = 0; i < bytes.size(); i += 4) {
    const GevStatus status = WriteWord(address + static_cast<uint32_t>(i), GetU32(&bytes[i]));
    if (status != GevStatus::kSuccess) return status;
  }
  return GevStatus::kSuccess;
}

GevStatus Registers::WriteWord(uint32_t address, uint32_t value) {
  const Span* span = Find(address);
  if (span == nullptr) {
    return address >= reg::kXmlBegin && address < memory_.size() ? GevStatus::kWriteProtect
                                                                 : GevStatus::kInvalidAddress;
  }
  if (!span->writable) return GevStatus::kWriteProtect;
  if (span->fixed_while_streaming && Word(reg::kAcquisitionActive) != 0) {
    return GevStatus::kAccessDenied;
  }
  if (!WithinRange(address, value)) return GevStatus::kInvalidParameter;
  const uint32_t old_value = Word(address);
  SetWord(address, value);
  AdjustTo(address, old_value);
  return GevStatus::kSuccess;
}

bool Registers::WithinRange(uint32_t address, uint32_t value) const {
  const Span& span = *Find(address);
  uint32_t max = span.max;
  if (address == reg::kWidth) max = Word(reg::kWidthMax) - Word(reg::kOffsetX);
  if (address == reg::kHeight) max = Word(reg::kHeightMax) - Word(reg::kOffsetY);
  if (address == reg::kOffsetX) max = Word(reg::kWidthMax) - Word(reg::kWidth);
  if (address == reg::kOffsetY) max = Word(reg::kHeightMax) - Word(reg::kHeight);
  return value >= span.min && value <= max;
}

void Registers::AdjustTo(uint32_t address, uint32_t old_value) {
  if (address == reg::kBinningX) Rescale(reg::kWidth, reg::kOffsetX, reg::kWidthMax, old_value);
  if (address == reg::kBinningY) Rescale(reg::kHeight, reg::kOffsetY, reg::kHeightMax, old_value);
}

void Registers::Rescale(uint32_t size, uint32_t offset, uint32_t size_max, uint32_t old_binning) {
  const uint32_t binning = Word(size == reg::kWidth ? reg::kBinningX : reg::kBinningY);
  const uint32_t max = Word(size_max);
  SetWord(size, std::clamp(Word(size) * old_binning / binning, 1u, max));
  SetWord(offset, std::min(Word(offset) * old_binning / binning, max - Word(size)));
}

uint32_t Registers::Get(uint32_t address) const {
  MutexLock lock(mutex_);
  return Word(address);
}

void Registers::Set(uint32_t address, uint32_t value) {
  MutexLock lock(mutex_);
  SetWord(address, value);
}

SensorSettings Registers::Sensor() const {
  MutexLock lock(mutex_);
  return {.exposure_us = static_cast<double>(Word(reg::kExposureUs)),
          .gain_raw = static_cast<int>(Word(reg::kGain)),
          .black_level_raw = static_cast<int>(Word(reg::kBlackLevel)),
          .binning_x = static_cast<int>(Word(reg::kBinningX)),
          .binning_y = static_cast<int>(Word(reg::kBinningY)),
          .offset_x = static_cast<int>(Word(reg::kOffsetX)),
          .offset_y = static_cast<int>(Word(reg::kOffsetY)),
          .width = static_cast<int>(Word(reg::kWidth)),
          .height = static_cast<int>(Word(reg::kHeight))};
}

int64_t Registers::PeriodNs() const {
  MutexLock lock(mutex_);
  return int64_t{Word(reg::kResultingPeriodUs)} * 1000;
}

// Some registers are computed from others.
uint32_t Registers::Word(uint32_t address) const {
  switch (address) {
    case reg::kWidthMax:
      return Word(reg::kSensorWidth) / Word(reg::kBinningX);
    case reg::kHeightMax:
      return Word(reg::kSensorHeight) / Word(reg::kBinningY);
    case reg::kPayloadSize:
      return Word(reg::kWidth) * Word(reg::kHeight);
    case reg::kResultingPeriodUs: {
      const auto readout_us = static_cast<uint32_t>(Word(reg::kHeight) * kRowReadoutNs / 1000);
      const uint32_t wanted_us = Word(reg::kFrameRateEnable) != 0 ? Word(reg::kFramePeriodUs) : 0;
      return std::max({readout_us, wanted_us, Word(reg::kExposureUs)});
    }
    default:
      return GetU32(&memory_[address]);
  }
}

void Registers::SetWord(uint32_t address, uint32_t value) { PutU32(&memory_[address], value); }

void Registers::SetText(uint32_t address, size_t size, std::string_view text) {
  std::copy_n(text.begin(), std::min(text.size(), size - 1), memory_.begin() + address);
}

}  // namespace vs::sim
