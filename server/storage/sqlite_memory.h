#pragma once

#include <cstdint>

namespace vs {

// SQLite counts the memory of the whole process only, but a stranger's statement must answer for
// its own. A statement runs on one thread, so memory is counted there.

// From now on; Database sees to it before it uses SQLite.
void CountSqliteMemory();

// What this thread has taken for SQLite less what it has given back; only differences say anything.
// Of the whole process where another library was the first to use SQLite, which allows no more
// counting then.
int64_t SqliteBytesOfThread();

}  // namespace vs
