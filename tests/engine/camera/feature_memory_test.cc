#include "engine/camera/feature_memory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vs {
namespace {

std::vector<std::string> Replayed(const FeatureMemory& memory) {
  std::vector<std::string> texts;
  for (const auto& [name, value] : memory.Replay()) {
    const auto* text = std::get_if<std::string>(&value);
    texts.push_back(name + "=" +
                    (text != nullptr ? *text : std::to_string(std::get<int64_t>(value))));
  }
  return texts;
}

TEST(FeatureMemory, KeepsTheOrderAndTheLastValue) {
  FeatureMemory memory;
  memory.Remember("Width", int64_t{640});
  memory.Remember("Height", int64_t{480});
  memory.Remember("Width", int64_t{320});
  EXPECT_THAT(Replayed(memory), testing::ElementsAre("Height=480", "Width=320"));
}

TEST(FeatureMemory, SetsEachFeatureUnderItsOwnSelector) {
  FeatureMemory memory;
  memory.Remember("TriggerSelector", "FrameStart");
  memory.Remember("TriggerMode", "On");
  memory.Remember("TriggerSelector", "AcquisitionStart");
  memory.Remember("TriggerMode", "Off");
  memory.Remember("TriggerSelector", "FrameStart");
  EXPECT_THAT(Replayed(memory),
              testing::ElementsAre("TriggerSelector=FrameStart", "TriggerMode=On",
                                   "TriggerSelector=AcquisitionStart", "TriggerMode=Off",
                                   "TriggerSelector=FrameStart"));
}

TEST(FeatureMemory, DoesNotGrowWhenTheSameIsSetOverAndOver) {
  FeatureMemory memory;
  for (int i = 0; i < 1000; ++i) {
    memory.Remember("GainSelector", i % 2 == 0 ? "All" : "Digital");
    memory.Remember("Gain", int64_t{i});
  }
  EXPECT_THAT(Replayed(memory), testing::ElementsAre("GainSelector=All", "Gain=998",
                                                     "GainSelector=Digital", "Gain=999"));
}

}  // namespace
}  // namespace vs
