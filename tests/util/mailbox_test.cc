// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/mailbox.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <thread>
#include <vector>

namespace hullslam {
namespace {

TEST(Mailbox, IsFirstInFirstOut) {
  Mailbox<int> mailbox(3);
  EXPECT_TRUE(mailbox.Send(1));
  EXPECT_TRUE(mailbox.Send(2));
  EXPECT_EQ(mailbox.Receive(), 1);
  EXPECT_EQ(mailbox.Receive(), 2);
}

TEST(Mailbox, CarriesMessagesThatCannotBeCopied) {
  Mailbox<std::unique_ptr<int>> mailbox(1);
  mailbox.Send(std::make_unique<int>(5));
  EXPECT_EQ(**mailbox.Receive(), 5);
}

TEST(Mailbox, AfterCloseDeliversSentMessagesAndAcceptsNoMore) {
  Mailbox<int> mailbox(2);
  mailbox.Send(1);
  mailbox.Close();
  EXPECT_FALSE(mailbox.Send(2));
  EXPECT_EQ(mailbox.Receive(), 1);
  EXPECT_EQ(mailbox.Receive(), std::nullopt);
  EXPECT_EQ(mailbox.Receive(), std::nullopt);
}

TEST(Mailbox, KeepsTheOrderBetweenThreads) {
  constexpr int kMessages = 5000;
  constexpr size_t kCapacity = 3;
  Mailbox<int> mailbox(kCapacity);
  std::thread sender([&] {
    for (int i = 0; i < kMessages; ++i) {
      EXPECT_TRUE(mailbox.Send(i));
    }
    mailbox.Close();
  });
  int expected = 0;
  while (const auto message = mailbox.Receive()) {
    EXPECT_EQ(*message, expected++);
  }
  sender.join();
  EXPECT_EQ(expected, kMessages);
}

TEST(Mailbox, SenderWaitsWhileFull) {
  Mailbox<int> mailbox(1);
  mailbox.Send(1);
  std::atomic<bool> sent{false};
  std::thread sender([&] {
    mailbox.Send(2);
    sent = true;
  });
  EXPECT_FALSE(sent.load()) << "nothing was received yet";
  EXPECT_EQ(mailbox.Receive(), 1);
  EXPECT_EQ(mailbox.Receive(), 2);
  sender.join();
  EXPECT_TRUE(sent.load());
}

TEST(Mailbox, CloseWakesAWaitingReceiver) {
  Mailbox<int> mailbox(1);
  std::optional<int> received = 1;
  std::thread receiver([&] { received = mailbox.Receive(); });
  mailbox.Close();
  receiver.join();
  EXPECT_EQ(received, std::nullopt);
}

TEST(Mailbox, CloseWakesAWaitingSender) {
  Mailbox<int> mailbox(1);
  mailbox.Send(1);
  bool sent = true;
  std::thread sender([&] { sent = mailbox.Send(2); });
  mailbox.Close();
  sender.join();
  EXPECT_FALSE(sent);
  EXPECT_EQ(mailbox.Receive(), 1);
  EXPECT_EQ(mailbox.Receive(), std::nullopt);
}

}  // namespace
}  // namespace hullslam
