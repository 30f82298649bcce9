// SPDX-License-Identifier: GPL-3.0-or-later
#include "util/between_threads.h"

#include <gtest/gtest.h>

#include <array>
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

TEST(Published, IsNullBeforeTheFirstPublish) { EXPECT_EQ(Published<int>().Get(), nullptr); }

TEST(Published, GivesTheNewest) {
  Published<int> published;
  published.Publish(std::make_shared<const int>(1));
  published.Publish(std::make_shared<const int>(2));
  EXPECT_EQ(*published.Get(), 2);
}

TEST(Published, ReadersKeepTheirVersionAndThePublisherFreesIt) {
  Published<int> published;
  published.Publish(std::make_shared<const int>(1));
  std::shared_ptr<const int> kept = published.Get();
  const std::weak_ptr<const int> watched = kept;
  published.Publish(std::make_shared<const int>(2));
  EXPECT_EQ(*kept, 1);
  published.Publish(std::make_shared<const int>(3));
  EXPECT_EQ(*kept, 1);
  kept.reset();
  EXPECT_FALSE(watched.expired()) << "the reader would have to wait until it is freed";
  published.Publish(std::make_shared<const int>(4));
  EXPECT_TRUE(watched.expired());
}

// A reader only sees complete values, and never an older value after a newer one.
TEST(Published, ReadersSeeCompleteValuesInOrder) {
  constexpr int kVersions = 3000;
  Published<std::array<int, 16>> published;
  std::thread writer([&] {
    for (int version = 1; version <= kVersions; ++version) {
      std::array<int, 16> value{};
      value.fill(version);
      published.Publish(std::make_shared<const std::array<int, 16>>(value));
    }
  });
  int last = 0;
  while (last < kVersions) {
    const auto value = published.Get();
    if (value == nullptr) {
      continue;
    }
    EXPECT_GE(value->front(), last);
    EXPECT_EQ(value->front(), value->back());
    last = value->front();
  }
  writer.join();
}

}  // namespace

}  // namespace hullslam
