// Combines single checks into one verdict on the part.
#include <array>

#include "engine/core/block.h"

namespace vs {
namespace {

class PassFail final : public Block {
 public:
  In<bool> a{this, "a", "The first check.", Need::kSome};
  In<bool> b{this, "b", "The second check.", Need::kSome};
  In<bool> c{this, "c", "The third check.", Need::kSome};
  In<bool> d{this, "d", "The fourth check.", Need::kSome};
  In<bool> e{this, "e", "The fifth check.", Need::kSome};
  In<bool> f{this, "f", "The sixth check.", Need::kSome};
  In<bool> g{this, "g", "The seventh check.", Need::kSome};
  In<bool> h{this, "h", "The eighth check.", Need::kSome};
  Out<bool> pass{this, "pass", "True when enough checks passed; false when that is not certain."};
  Out<std::string> result_class{this, "result_class",
                                "The verdict: pass, fail, or undefined when it depends on a check "
                                "that gave no answer."};
  Param<std::string> mode{this,
                          "mode",
                          {.initial = "all",
                           .choices = {"all", "any", "at_least"},
                           .doc = "How many of the connected checks must pass."}};
  Param<int> needed{
      this,
      "needed",
      {.initial = 1, .min = 1, .max = 8, .doc = "How many must pass when the mode is at_least."}};

  Status Run() override {
    int connected = 0;
    int passed = 0;
    int unknown = 0;  // the block that should have said failed in this frame
    for (const In<bool>* check : std::array{&a, &b, &c, &d, &e, &f, &g, &h}) {
      if (!check->connected()) continue;
      ++connected;
      if (!check->has_value()) {
        ++unknown;
      } else if (**check) {
        ++passed;
      }
    }
    const int enough = *mode == "all" ? connected : *mode == "any" ? 1 : *needed;
    pass.Set(passed >= enough);
    result_class.Set(passed >= enough ? "pass" : passed + unknown >= enough ? "undefined" : "fail");
    return Status();
  }
};

VS_REGISTER_BLOCK(PassFail, {.category = "Logic",
                             .doc = "Combines several checks into one verdict on the part."});

}  // namespace
}  // namespace vs
