#pragma once

#include "engine/base/status.h"
#include "tests/support/test_server.h"

namespace vs::test {

// Gives a server what deploy/run.sh gives it, the rig and the sequence of deploy/demo, and starts
// it anew; the sequence `stereo_depth` then starts by itself.
Status RestartAsDemo(TestServer* server);

}  // namespace vs::test
