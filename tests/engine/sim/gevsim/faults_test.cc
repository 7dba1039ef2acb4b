#include "engine/sim/gevsim/faults.h"

#include <gtest/gtest.h>

namespace vs::sim {
namespace {

TEST(Faults, AreSetByWords) {
  Faults faults;
  EXPECT_TRUE(faults.Apply("drop 0.25", 0).ok());
  EXPECT_TRUE(faults.Apply("drop-frames 1", 0).ok());
  EXPECT_TRUE(faults.Apply("reorder 0.5", 0).ok());
  EXPECT_TRUE(faults.Apply("duplicate 0.125", 0).ok());
  EXPECT_TRUE(faults.Apply("payload-type 6 10", 0).ok());
  EXPECT_TRUE(faults.Apply("freeze 1.5", 1000).ok());
  EXPECT_TRUE(faults.Apply("unplug", 0).ok());
  EXPECT_TRUE(faults.Apply("black on", 0).ok());
  EXPECT_TRUE(faults.Apply("slow-answer 20", 0).ok());
  const FaultSettings settings = faults.Get();
  EXPECT_EQ(settings.drop_packets, 0.25);
  EXPECT_EQ(settings.drop_frames, 1.0);
  EXPECT_EQ(settings.reorder_packets, 0.5);
  EXPECT_EQ(settings.duplicate_packets, 0.125);
  EXPECT_EQ(settings.wrong_type, 6);
  EXPECT_EQ(settings.wrong_type_every, 10);
  EXPECT_EQ(settings.frozen_until_ns, 1'500'001'000);
  EXPECT_TRUE(settings.unplugged);
  EXPECT_TRUE(settings.black);
  EXPECT_EQ(settings.slow_answer_ms, 20);
}

TEST(Faults, CanBeTakenBack) {
  Faults faults;
  EXPECT_TRUE(faults.Apply("unplug", 0).ok());
  EXPECT_TRUE(faults.Apply("plug", 0).ok());
  EXPECT_FALSE(faults.Get().unplugged);
  EXPECT_TRUE(faults.Apply("drop 0.5", 0).ok());
  EXPECT_TRUE(faults.Apply("black on", 0).ok());
  EXPECT_TRUE(faults.Apply("clear", 0).ok());
  EXPECT_EQ(faults.Get().drop_packets, 0.0);
  EXPECT_FALSE(faults.Get().black);
}

TEST(Faults, RefuseWhatMakesNoSenseAndChangeNothing) {
  Faults faults;
  for (const char* command :
       {"", "drip 0.1", "drop", "drop x", "drop 1.5", "drop -1", "drop 0.1 0.2", "payload-type 6",
        "payload-type 70000 1", "payload-type 6 -1", "freeze", "freeze -1", "freeze 1e300", "black",
        "black maybe", "unplug now", "slow-answer", "slow-answer -5"}) {
    const Status status = faults.Apply(command, 0);
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument) << command;
    EXPECT_FALSE(status.message().empty());
  }
  EXPECT_EQ(faults.Get().drop_packets, 0.0);
  EXPECT_FALSE(faults.Get().unplugged);
}

TEST(Faults, HappenAsOftenAsTheirProbabilitySays) {
  Faults faults;
  int happened = 0;
  for (int i = 0; i < 100'000; ++i) {
    EXPECT_FALSE(faults.Happens(0));
    EXPECT_TRUE(faults.Happens(1));
    happened += faults.Happens(0.1) ? 1 : 0;
  }
  EXPECT_NEAR(happened, 10'000, 500);
}

}  // namespace
}  // namespace vs::sim
