// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/mailbox.h"

#include <gtest/gtest.h>

namespace {

struct Message {
  std::int64_t utime = 0;
  int value = 0;
};

// Nothing put, nothing taken.
TEST(Mailbox, EmptyGivesNull) {
  runtime::InputCounts counts;
  runtime::Mailbox<Message> mailbox(counts);
  EXPECT_EQ(mailbox.take(0), nullptr);
  EXPECT_FALSE(mailbox.fresh());
}

// The newest message wins, is given once, and what it replaced is counted.
TEST(Mailbox, NewestWins) {
  runtime::InputCounts counts;
  runtime::Mailbox<Message> mailbox(counts);
  for (int i = 1; i <= 3; ++i) {
    Message message{100 * i, i};
    mailbox.put(message);
  }
  const Message* taken = mailbox.take(350);
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(taken->value, 3);
  EXPECT_EQ(mailbox.take(350), nullptr);
  EXPECT_EQ(counts.overwritten, 2);
  EXPECT_EQ(counts.age_us.quantile(0.5), 50);
}

// A queue keeps order, drops what finds it full, and can be used again after it was emptied.
TEST(Queue, BoundedFirstInFirstOut) {
  runtime::InputCounts counts;
  runtime::Queue<Message> queue(counts, 2);
  for (int round = 0; round < 3; ++round) {
    for (int i = 1; i <= 3; ++i) {
      Message message{0, i};
      queue.put(message);
    }
    EXPECT_EQ(queue.take(0)->value, 1);
    EXPECT_EQ(queue.take(0)->value, 2);
    EXPECT_EQ(queue.take(0), nullptr);
  }
  EXPECT_EQ(counts.overwritten, 3);
}

}  // namespace
