#pragma once

#include <cstdint>

// Addresses of the bootstrap registers that every GigE Vision device has (GigE Vision specification
// 2.0, chapter 28), and of our camera's own, which camera.xml tells to clients.
namespace vs::sim::reg {

inline constexpr uint32_t kVersion = 0x0000;
inline constexpr uint32_t kDeviceMode = 0x0004;
inline constexpr uint32_t kMacHigh = 0x0008;
inline constexpr uint32_t kMacLow = 0x000c;
inline constexpr uint32_t kIpOptions = 0x0010;
inline constexpr uint32_t kIpConfiguration = 0x0014;
inline constexpr uint32_t kCurrentAddress = 0x0024;
inline constexpr uint32_t kCurrentSubnetMask = 0x0034;
inline constexpr uint32_t kManufacturerName = 0x0048;  // 32 bytes
inline constexpr uint32_t kModelName = 0x0068;         // 32
inline constexpr uint32_t kDeviceVersion = 0x0088;     // 32
inline constexpr uint32_t kManufacturerInfo = 0x00a8;  // 48
inline constexpr uint32_t kSerialNumber = 0x00d8;      // 16
inline constexpr uint32_t kUserName = 0x00e8;          // 16
inline constexpr uint32_t kDiscoveryEnd = 0x00f8;      // a discovery answer is all before it
inline constexpr uint32_t kXmlUrl = 0x0200;            // 512
inline constexpr uint32_t kSecondXmlUrl = 0x0400;      // 512
inline constexpr uint32_t kInterfaceCount = 0x0600;
inline constexpr uint32_t kMessageChannelCount = 0x0900;
inline constexpr uint32_t kStreamChannelCount = 0x0904;
inline constexpr uint32_t kActionSignalCount = 0x0908;
inline constexpr uint32_t kActionDeviceKey = 0x090c;
inline constexpr uint32_t kGvcpCapability = 0x0934;
inline constexpr uint32_t kHeartbeatTimeout = 0x0938;  // ms
inline constexpr uint32_t kTickFrequencyHigh = 0x093c;
inline constexpr uint32_t kTickFrequencyLow = 0x0940;
inline constexpr uint32_t kTimestampControl = 0x0944;  // 2: latch the counter
inline constexpr uint32_t kTimestampHigh = 0x0948;
inline constexpr uint32_t kTimestampLow = 0x094c;
inline constexpr uint32_t kControlPrivilege = 0x0a00;
inline constexpr uint32_t kStreamPort = 0x0d00;
inline constexpr uint32_t kStreamPacketSize = 0x0d04;
inline constexpr uint32_t kStreamPacketDelay = 0x0d08;  // ticks
inline constexpr uint32_t kStreamDestination = 0x0d18;
inline constexpr uint32_t kStreamSourcePort = 0x0d1c;
inline constexpr uint32_t kActionGroupKey = 0x9800;
inline constexpr uint32_t kActionGroupMask = 0x9804;

inline constexpr uint32_t kWidth = 0xa000;
inline constexpr uint32_t kHeight = 0xa004;
inline constexpr uint32_t kOffsetX = 0xa008;
inline constexpr uint32_t kOffsetY = 0xa00c;
inline constexpr uint32_t kBinningX = 0xa010;
inline constexpr uint32_t kBinningY = 0xa014;
inline constexpr uint32_t kPixelFormat = 0xa018;
inline constexpr uint32_t kSensorWidth = 0xa01c;
inline constexpr uint32_t kSensorHeight = 0xa020;
inline constexpr uint32_t kWidthMax = 0xa024;
inline constexpr uint32_t kHeightMax = 0xa028;
inline constexpr uint32_t kPayloadSize = 0xa02c;
inline constexpr uint32_t kAcquisitionMode = 0xa030;
inline constexpr uint32_t kAcquisitionStart = 0xa034;
inline constexpr uint32_t kAcquisitionStop = 0xa038;
inline constexpr uint32_t kAcquisitionActive = 0xa03c;
inline constexpr uint32_t kExposureUs = 0xa040;
inline constexpr uint32_t kExposureAuto = 0xa044;
inline constexpr uint32_t kGain = 0xa048;
inline constexpr uint32_t kGainAuto = 0xa04c;
inline constexpr uint32_t kBlackLevel = 0xa050;
inline constexpr uint32_t kFramePeriodUs = 0xa054;
inline constexpr uint32_t kFrameRateEnable = 0xa058;
inline constexpr uint32_t kResultingPeriodUs = 0xa05c;
inline constexpr uint32_t kTriggerSelector = 0xa060;
inline constexpr uint32_t kTriggerSoftware = 0xa064;
// Of FrameStart; AcquisitionStart's are kTriggerStep further.
inline constexpr uint32_t kTriggerMode = 0xa080;
inline constexpr uint32_t kTriggerSource = 0xa084;
inline constexpr uint32_t kTriggerActivation = 0xa088;
inline constexpr uint32_t kTriggerStep = 0x10;

inline constexpr uint32_t kXmlBegin = 0x10000;

}  // namespace vs::sim::reg

namespace vs::sim {

// Values of some registers.
inline constexpr uint32_t kPixelFormatMono8 = 0x01080001;
enum class AcquisitionMode : uint32_t { kContinuous = 0, kSingleFrame = 1 };
enum class TriggerSource : uint32_t { kSoftware = 0, kLine1 = 1, kAction1 = 2 };
inline constexpr uint32_t kTestPacketFlag = 0x80000000;   // of kStreamPacketSize
inline constexpr uint32_t kNoFragmentsFlag = 0x40000000;  // of kStreamPacketSize
inline constexpr uint32_t kStreamPacketSizeMask = 0x0000ffff;
inline constexpr uint32_t kTimestampLatch = 2;
inline constexpr uint32_t kPrivilegeExclusive = 1;
inline constexpr uint32_t kPrivilegeControl = 2;

}  // namespace vs::sim
