#include "engine/sim/gevsim/control_privilege.h"

#include <gtest/gtest.h>

#include "engine/sim/gevsim/register_addresses.h"

namespace vs::sim {
namespace {

constexpr Endpoint kFirst = {0x7f000001, 5000};
constexpr Endpoint kSecond = {0x7f000001, 5001};

TEST(ControlPrivilege, BelongsToNobodyAtFirst) {
  const ControlPrivilege privilege;
  EXPECT_TRUE(privilege.MayRead(kFirst));
  EXPECT_FALSE(privilege.MayWrite(kFirst));
  EXPECT_EQ(privilege.RegisterValue(), 0u);
}

TEST(ControlPrivilege, IsRefusedToASecondClient) {
  ControlPrivilege privilege;
  EXPECT_EQ(privilege.Request(kFirst, kPrivilegeControl, 0), GevStatus::kSuccess);
  EXPECT_EQ(privilege.Request(kSecond, kPrivilegeControl, 0), GevStatus::kAccessDenied);
  EXPECT_EQ(privilege.Request(kSecond, 0, 0), GevStatus::kAccessDenied);
  EXPECT_TRUE(privilege.MayWrite(kFirst));
  EXPECT_FALSE(privilege.MayWrite(kSecond));
  EXPECT_TRUE(privilege.MayRead(kSecond));
  EXPECT_EQ(privilege.RegisterValue(), kPrivilegeControl);
}

TEST(ControlPrivilege, KeepsOthersFromReadingWhenExclusive) {
  ControlPrivilege privilege;
  EXPECT_EQ(privilege.Request(kFirst, kPrivilegeExclusive, 0), GevStatus::kSuccess);
  EXPECT_TRUE(privilege.MayRead(kFirst));
  EXPECT_FALSE(privilege.MayRead(kSecond));
  EXPECT_EQ(privilege.Request(kFirst, kPrivilegeControl, 0), GevStatus::kSuccess);
  EXPECT_TRUE(privilege.MayRead(kSecond));
}

TEST(ControlPrivilege, CanBeGivenUp) {
  ControlPrivilege privilege;
  EXPECT_EQ(privilege.Request(kFirst, kPrivilegeControl, 0), GevStatus::kSuccess);
  EXPECT_EQ(privilege.Request(kFirst, 0, 0), GevStatus::kSuccess);
  EXPECT_EQ(privilege.Request(kSecond, kPrivilegeControl, 0), GevStatus::kSuccess);
}

TEST(ControlPrivilege, IsLostBySilenceOnly) {
  ControlPrivilege privilege;
  EXPECT_EQ(privilege.Request(kFirst, kPrivilegeControl, 1000), GevStatus::kSuccess);
  privilege.Heard(kFirst, 3000);
  privilege.Heard(kSecond, 3500);  // somebody else's word does not count
  EXPECT_FALSE(privilege.ExpireSilent(4000, 1000));
  EXPECT_TRUE(privilege.ExpireSilent(4001, 1000));
  EXPECT_FALSE(privilege.Held());
  EXPECT_FALSE(privilege.ExpireSilent(9000, 1000));
}

}  // namespace
}  // namespace vs::sim
