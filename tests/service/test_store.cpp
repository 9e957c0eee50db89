// The queue: leases, attempts, fairness, and what is left of them after a crash.

#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "store_fixture.hpp"

namespace talus::service {
namespace {

using namespace test_store;

TEST_F(StoreTest, AJobIsThereAfterReopening) {
  add("one", 3, 2);
  store = open();
  const Job found = job("one");
  EXPECT_EQ(found.state, JobState::accepted);
  EXPECT_EQ(found.planned, 3);
  EXPECT_EQ(found.created, 1'000'000);
  EXPECT_FALSE(found.started);
  EXPECT_FALSE(store->job("two"));
}

TEST_F(StoreTest, RunsAreClaimedOnceEachOriginThenFloorThenTheRest) {
  const Job made = add("one", 3, 2);
  std::vector<std::string> order;
  while (const auto claim = store->claim())
    order.push_back((claim->key.is_replicate() ? "f" : "r") + std::to_string(claim->key.index));
  EXPECT_EQ(order, (std::vector<std::string>{"r0", "f1", "f2", "r1", "r2"}));
  EXPECT_EQ(job("one").state, JobState::running);
  EXPECT_TRUE(store->complete_jobs().empty());
  EXPECT_EQ(made.seed, 0);
}

TEST_F(StoreTest, ClaimsAreSharedByTwoThreads) {
  add("one", 200);
  std::mutex mutex;
  std::multiset<std::int64_t> seen;
  const auto work = [&] {
    while (const auto claim = store->claim()) {
      store->accept(*claim, result(1));
      const std::lock_guard lock(mutex);
      seen.insert(claim->key.index);
    }
  };
  std::thread a(work), b(work);
  a.join();
  b.join();
  EXPECT_EQ(seen.size(), 200u);
  EXPECT_EQ(std::set(seen.begin(), seen.end()).size(), 200u);
  EXPECT_EQ(job("one").done, 200);
}

TEST_F(StoreTest, AResultCountsOnlyFromTheCurrentAttempt) {
  add("one", 1);
  const Claim first = *store->claim();
  now += lease + 1;
  EXPECT_EQ(requeued(), 1);
  const Claim second = *store->claim();
  EXPECT_EQ(second.attempt, first.attempt + 1);
  EXPECT_FALSE(store->is_current(first));
  EXPECT_FALSE(store->accept(first, result(1)));
  EXPECT_FALSE(store->fail(first, {.reason = "late"}));
  EXPECT_FALSE(store->give_back(first, true));
  EXPECT_EQ(job("one").done, 0);
  EXPECT_TRUE(store->accept(second, result(2)));
  EXPECT_FALSE(store->accept(second, result(3)));
  EXPECT_EQ(job("one").done, 1);
  EXPECT_EQ(store->run(second.study, second.key)->result->measures.influence_zone, 2);
}

TEST_F(StoreTest, RenewingKeepsALeaseAndTellsOfALostOne) {
  add("one", 2);
  const Claim kept = *store->claim(), lost = *store->claim();
  now += lease - 1;
  EXPECT_TRUE(store->renew(std::vector{kept}).empty());
  now += 2;
  EXPECT_EQ(requeued(), 1);
  EXPECT_EQ(store->renew(std::vector{kept, lost}), (std::vector<std::size_t>{1}));
}

TEST_F(StoreTest, AClockSetBackDoesNotHoldALeaseForEver) {
  add("one", 1);
  store->claim();
  now -= 3'600'000;
  EXPECT_EQ(requeued(), 1);
}

TEST_F(StoreTest, WhatIsHeldSurvivesAnyJumpOfTheClock) {
  add("one", 1);
  const Claim held = *store->claim();
  for (const Milliseconds jump : {3'600'000, -7'200'000, 86'400'000}) {
    now += jump;
    const Store::Renewal renewal = store->renew_leases(std::vector{held});
    EXPECT_TRUE(renewal.lost.empty());
    EXPECT_EQ(renewal.requeued, 0);
  }
}

TEST_F(StoreTest, ReopeningPutsBackEveryLeaseButNoResult) {
  add("one", 3);
  const Claim done = *store->claim();
  store->accept(done, result(1));
  store->claim();
  store = open();
  EXPECT_EQ(store->requeue_all(), 1);
  EXPECT_EQ(store->state_counts().runs[static_cast<std::size_t>(RunState::queued)], 2);
  EXPECT_EQ(store->state_counts().runs[static_cast<std::size_t>(RunState::done)], 1);
  EXPECT_EQ(store->claim()->attempt, 2);
}

TEST_F(StoreTest, OneHugeJobDoesNotStarveASmallOne) {
  add("huge", 1000);
  std::vector<Claim> running;
  for (int i = 0; i < 4; ++i) running.push_back(*store->claim());
  add("small", 3);
  std::string order;
  for (int i = 0; i < 4; ++i) {  // the huge one's runs end; the small one gets every place until it has as many
    store->accept(running.front(), result(1));
    running.erase(running.begin());
    running.push_back(*store->claim());
    order += store->job(running.back().study)->id + " ";
  }
  EXPECT_EQ(order, "small small huge huge ");
}

TEST_F(StoreTest, EqualJobsTakeTurns) {
  add("a", 100);
  add("b", 100);
  std::string order;
  for (int i = 0; i < 6; ++i) {
    const Claim claim = *store->claim();
    order += store->job(claim.study)->id;
    store->accept(claim, result(1));
  }
  EXPECT_EQ(order, "ababab");
}

TEST_F(StoreTest, CrashesAreCountedInterruptionsAreNot) {
  add("one", 1);
  store->give_back(*store->claim(), false);
  store->give_back(*store->claim(), true);
  const Claim third = *store->claim();
  EXPECT_EQ(third.attempt, 3);
  EXPECT_EQ(third.crashes, 1);
  EXPECT_TRUE(store->fail(third, {.reason = "killed", .signal = 9, .log_tail = "tail"}));
  const service::Run run = *store->run(third.study, third.key);
  EXPECT_EQ(run.failure->signal, 9);
  EXPECT_FALSE(run.failure->exit_code);
  EXPECT_EQ(run.failure->log_tail, "tail");
  EXPECT_EQ(job("one").failed, 1);
}

TEST_F(StoreTest, AJobEndsOnlyWhenNothingOfItIsLeft) {
  const Job made = add("one", 1);
  const Claim claim = *store->claim();
  EXPECT_FALSE(store->finish(made.number, JobState::successful, ""));
  store->accept(claim, result(1));
  ASSERT_EQ(store->complete_jobs().size(), 1u);
  EXPECT_TRUE(store->finish(made.number, JobState::successful, "done"));
  EXPECT_TRUE(job("one").finished);
  EXPECT_TRUE(store->complete_jobs().empty());
  EXPECT_FALSE(store->finish(made.number, JobState::failed, "again"));
}

TEST_F(StoreTest, AnOpenJobSaysWhyItWaits) {
  const Job made = add("one", 1);
  store->note_pending_reason(made.number, "waits for rain");
  EXPECT_EQ(job("one").message, "waits for rain");
  EXPECT_GT(job("one").version, made.version);
  store->accept(*store->claim(), result(1));
  store->finish(made.number, JobState::successful, "done");
  store->note_pending_reason(made.number, "waits for rain");
  EXPECT_EQ(job("one").message, "done");
}

TEST_F(StoreTest, DismissingTakesTheRunsAway) {
  const Job made = add("one", 3);
  const Claim claim = *store->claim();
  store->dismiss(made.number);
  EXPECT_FALSE(store->accept(claim, result(1)));
  EXPECT_EQ(store->renew(std::vector{claim}).size(), 1u);
  EXPECT_FALSE(store->claim());
  EXPECT_EQ(job("one").state, JobState::dismissed);
}

TEST_F(StoreTest, RetryTakesOnlyTheFailedOnes) {
  const Job made = add("one", 2);
  store->accept(*store->claim(), result(1));
  store->fail(*store->claim(), {.reason = "diverged", .exit_code = 4});
  store->finish(made.number, JobState::failed, "");
  EXPECT_EQ(store->retry_failed(made.number), 1);
  EXPECT_EQ(job("one").state, JobState::running);
  EXPECT_EQ(job("one").failed, 0);
  EXPECT_EQ(store->claim()->key.index, 1);
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, AStudyThatStopsEarlyKeepsItsReplicates) {
  const Job made = add("one", 4, 2);
  store->accept(*store->claim(), result(1));
  const Claim replicate = *store->claim(), later = *store->claim(), realization = *store->claim();
  store->drop_open_runs(made.number, false);
  EXPECT_TRUE(store->is_current(replicate));
  EXPECT_TRUE(store->is_current(later));
  EXPECT_FALSE(store->is_current(realization));
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, AnAbortedJobSaysWhyAndGoesOnWhenRetried) {
  const Job made = add("one", 3, 1);
  store->accept(*store->claim(), result(1));
  const Claim claim = *store->claim();
  store->abort(made.number, true, "refuses the case");
  EXPECT_FALSE(store->is_current(claim));
  EXPECT_EQ(job("one").state, JobState::failed);
  EXPECT_EQ(job("one").message, "refuses the case");
  EXPECT_EQ(store->retry_failed(made.number), 0);
  EXPECT_EQ(job("one").state, JobState::running);
  std::string order;
  while (const auto next = store->claim())
    order += (next->key.is_replicate() ? "f" : "r") + std::to_string(next->key.index);
  EXPECT_EQ(order, "f1r1r2");
}

TEST_F(StoreTest, TheEngineSeesEveryRecord) {
  const Job made = add("one", 3, 1);
  store->accept(*store->claim(), result(7.0));
  store->accept(*store->claim(), result(8.0));
  store->fail(*store->claim(), {.reason = "diverged"});
  std::string seen;
  store->visit_records(made.number, [&](const RunKey& key, std::optional<double> zone) {
    seen += work_name(key) + (zone ? " " + std::to_string(static_cast<int>(*zone)) : " failed") + "; ";
  });
  EXPECT_EQ(seen, "000000 7; 000001 failed; floor-1 8; ");
  const StudyInfo info = store->study(made.number);
  EXPECT_EQ(info.name, "one");
  EXPECT_EQ(info.paths.root, directory / "jobs" / "one");
  EXPECT_EQ(info.end, 3);
  EXPECT_EQ(info.spec.noise_floor_replicates, 1);
}

TEST_F(StoreTest, ExtendingLeavesWhatIsThere) {
  const Job made = add("one", 2, 1);
  while (const auto claim = store->claim()) store->accept(*claim, result(1));
  store->finish(made.number, JobState::successful, "");
  EXPECT_TRUE(store->extend(made.number, 4));
  EXPECT_EQ(job("one").planned, 4);
  EXPECT_EQ(job("one").done, 2);
  EXPECT_FALSE(job("one").finished);
  EXPECT_EQ(store->claim()->key.index, 2);
  EXPECT_EQ(store->claim()->key.index, 3);
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, ADismissedJobIsNotExtended) {
  const Job made = add("one", 1);
  store->dismiss(made.number);
  store->extend(made.number, 5);
  EXPECT_EQ(job("one").state, JobState::dismissed);
  EXPECT_EQ(job("one").planned, 1);
  EXPECT_FALSE(store->claim());
}

TEST_F(StoreTest, AKeyIsStoredResponseWithTheJobOrNeither) {
  const auto answer = [](const Job& j) {
    return StoredResponse{
        .subject = "a", .key = "k", .body_hash = "h", .status = 201, .location = "/" + j.id, .body = "b"};
  };
  const NewJob first{.id = "one", .process = "echo", .subject = "a"};
  NewJob second = first;
  second.id = "two";
  EXPECT_TRUE(store->create(first, answer));
  EXPECT_FALSE(store->create(second, answer));
  EXPECT_FALSE(store->job("two"));
  EXPECT_EQ(store->stored_response("a", "k")->location, "/one");
  EXPECT_FALSE(store->stored_response("b", "k"));
}

TEST_F(StoreTest, AKeyIsForgottenAfterAWeek) {
  const auto with_key = [](const char* key) {
    return [key](const Job&) { return StoredResponse{.subject = "a", .key = key, .body_hash = "h"}; };
  };
  store->create({.id = "one", .process = "echo", .subject = "a"}, with_key("old"));
  now += Milliseconds{8} * 24 * 3600 * 1000;
  store->create({.id = "two", .process = "echo", .subject = "a"}, with_key("new"));
  EXPECT_FALSE(store->stored_response("a", "old"));
  EXPECT_TRUE(store->stored_response("a", "new"));
}

}  // namespace
}  // namespace talus::service
