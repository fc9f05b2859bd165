// SPDX-License-Identifier: BSD-3-Clause
// Lines from a pipe: nothing, halves, many, too long, closed.
#include "simulator/plant/line_reader.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace simulator {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Pipe {
  Pipe() { EXPECT_EQ(::pipe(ends), 0); }
  ~Pipe() {
    ::close(ends[0]);
    close_write();
  }
  void write(const std::string& text) {
    EXPECT_EQ(::write(ends[1], text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  void close_write() {
    if (ends[1] >= 0) ::close(ends[1]);
    ends[1] = -1;
  }
  int ends[2] = {-1, -1};
};

// Nothing is waited for, and a line counts when its end has come.
TEST(LineReader, WholeLinesOnly) {
  Pipe pipe;
  LineReader reader(pipe.ends[0]);
  EXPECT_THAT(reader.take(), IsEmpty());
  pipe.write("est");
  EXPECT_THAT(reader.take(), IsEmpty());
  pipe.write("op\n\nundock\nhal");
  EXPECT_THAT(reader.take(), ElementsAre("estop", "", "undock"));
  pipe.write("f\n");
  EXPECT_THAT(reader.take(), ElementsAre("half"));
}

// Without an end it does not grow for ever; what comes behind is read again.
TEST(LineReader, DropsWhatHasNoEnd) {
  Pipe pipe;
  LineReader reader(pipe.ends[0]);
  pipe.write(std::string(5000, 'x'));
  EXPECT_THAT(reader.take(), IsEmpty());
  pipe.write("dock\n");
  EXPECT_THAT(reader.take(), ElementsAre("dock"));
}

// The other side has gone: what it said counts, and nothing comes after.
TEST(LineReader, TheOtherSideCloses) {
  Pipe pipe;
  LineReader reader(pipe.ends[0]);
  pipe.write("dock\n");
  pipe.close_write();
  EXPECT_THAT(reader.take(), ElementsAre("dock"));
  EXPECT_EQ(reader.descriptor(), -1);
  EXPECT_THAT(reader.take(), IsEmpty());
  EXPECT_THAT(LineReader(-1).take(), IsEmpty());
}

}  // namespace
}  // namespace simulator
