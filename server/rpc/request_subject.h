#pragma once

#include <optional>
#include <string>

namespace google::protobuf {
class Message;
}

namespace vs {

// What a request is about, for a record of who changed what: whom or what it names, and which parts
// of that it sets, as in "stereo_depth: match.p1, match.p2" or "ana: role". Taken from fields with
// the names that such fields have in our API (id, name, sequence, user ..., path, reason); all
// other fields, so every secret, are passed by. Nothing when the request only asks for a check
// (`validate_only`).
std::optional<std::string> SubjectOf(const google::protobuf::Message& request);

}  // namespace vs
