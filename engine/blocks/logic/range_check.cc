// Says whether a number lies within limits, and by how much.
#include <algorithm>
#include <limits>

#include "engine/base/str.h"
#include "engine/core/block.h"

namespace vs {
namespace {

class RangeCheck final : public Block {
 public:
  In<double> value{this, "value", "The number to check."};
  Out<bool> pass{this, "pass", "True when the value lies within the limits."};
  Out<std::string> result_class{this, "result_class", "The verdict: pass, warn or fail."};
  Out<double> margin{this, "margin",
                     "Distance to the nearest limit, negative outside, in the unit of the value."};
  Param<std::string> limits{this,
                            "limits",
                            {.initial = "both",
                             .choices = {"both", "min", "max"},
                             .doc = "Which of the two limits count."}};
  Param<double> min{this,
                    "min",
                    {.initial = 0,
                     .operator_editable = true,
                     .doc = "Smallest good value, in the unit of the value."}};
  Param<double> max{this,
                    "max",
                    {.initial = 1,
                     .operator_editable = true,
                     .doc = "Largest good value, in the unit of the value."}};
  Param<double> warn_margin{this,
                            "warn_margin",
                            {.initial = 0,
                             .min = 0,
                             .operator_editable = true,
                             .doc = "A good value nearer than this to a limit is a warning; 0 = "
                                    "never."}};

  Status CheckParams() const override {
    if (*limits != "both" || *min <= *max) return Status();
    return InvalidArgument(Str("min (", *min, ") must not be above max (", *max, ")"));
  }

  Status Run() override {
    const bool low = *limits != "max";
    const bool high = *limits != "min";
    constexpr double kNone = std::numeric_limits<double>::infinity();
    const double distance = std::min(low ? *value - *min : kNone, high ? *max - *value : kNone);
    const bool good = distance >= 0;  // not for NaN
    pass.Set(good);
    result_class.Set(!good ? "fail" : distance < *warn_margin ? "warn" : "pass");
    margin.Set(distance);
    return Status();
  }
};

VS_REGISTER_BLOCK(RangeCheck,
                  {.category = "Logic",
                   .doc = "Checks whether a number lies within limits, and says by how much."});

}  // namespace
}  // namespace vs
