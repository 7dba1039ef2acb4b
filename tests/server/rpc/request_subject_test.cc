#include "server/rpc/request_subject.h"

#include <gtest/gtest.h>

#include "visionserver/v1/camera.pb.h"
#include "visionserver/v1/parameter.pb.h"
#include "visionserver/v1/sequence.pb.h"
#include "visionserver/v1/session.pb.h"
#include "visionserver/v1/user.pb.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;

TEST(RequestSubject, IsWhatTheRequestNames) {
  pb::StartSequenceRequest start;
  EXPECT_EQ(SubjectOf(start), "");
  start.set_id("stereo_depth");
  EXPECT_EQ(SubjectOf(start), "stereo_depth");
  pb::DeleteUserRequest remove;
  remove.set_name("ana");
  EXPECT_EQ(SubjectOf(remove), "ana");
  pb::RevokeSessionRequest revoke;
  revoke.set_session_id("s1");
  EXPECT_EQ(SubjectOf(revoke), "s1");
}

TEST(RequestSubject, TellsWhichPartsAreSet) {
  pb::SetParametersRequest set;
  set.set_sequence("stereo_depth");
  set.add_values()->set_path("match.p1");
  set.add_values()->set_path("match.p2");
  EXPECT_EQ(SubjectOf(set), "stereo_depth: match.p1, match.p2");
  set.set_reason("new lamp");
  EXPECT_EQ(SubjectOf(set), "stereo_depth: match.p1, match.p2 (new lamp)");
  pb::ResetParametersRequest reset;
  reset.set_sequence("stereo_depth");
  reset.add_paths("match.p1");
  EXPECT_EQ(SubjectOf(reset), "stereo_depth: match.p1");
  pb::SetFeaturesRequest features;
  features.set_id("left");
  features.add_values()->set_name("Gain");
  EXPECT_EQ(SubjectOf(features), "left: Gain");
  pb::UpdateUserRequest update;
  update.set_name("ana");
  update.set_role(pb::ROLE_ADMIN);
  update.set_disabled(false);
  EXPECT_EQ(SubjectOf(update), "ana: role, disabled");
}

TEST(RequestSubject, HoldsNoSecret) {
  pb::LoginRequest login;
  login.set_user("ana");
  login.set_password("correct horse battery");
  EXPECT_EQ(SubjectOf(login), "ana");
  pb::ChangePasswordRequest change;
  change.set_old_password("correct horse battery");
  change.set_new_password("incorrect horse battery");
  EXPECT_EQ(SubjectOf(change), "");
}

TEST(RequestSubject, ThereIsNoneOfAMereCheck) {
  pb::SetParametersRequest set;
  set.set_sequence("stereo_depth");
  set.set_validate_only(true);
  EXPECT_EQ(SubjectOf(set), std::nullopt);
}

}  // namespace
}  // namespace vs
