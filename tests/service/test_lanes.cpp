// The threads of the handlers.

#include <gtest/gtest.h>

#include <future>

#include "http/lanes.hpp"
#include "http/places.hpp"

namespace talus::service {
namespace {

/// Work that waits until it is let go.
class Held {
 public:
  std::function<void()> work() {
    return [gate = gate_] { gate.wait(); };
  }
  void let_go() { open_.set_value(); }

 private:
  std::promise<void> open_;
  std::shared_future<void> gate_ = open_.get_future().share();
};

TEST(Lanes, DoAllTheirWork) {
  std::atomic<int> done{0};
  WorkLane lane({.threads = 3, .places = 1000, .places_each = 1000});
  for (int i = 0; i < 1000; ++i) EXPECT_TRUE(lane.submit(std::to_string(i % 7), [&] { ++done; }));
  lane.join();
  EXPECT_EQ(done, 1000);
}

TEST(Lanes, HavePlacesInAllAndForEach) {
  Held held;
  WorkLane lane({.threads = 1, .places = 5, .places_each = 3});
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(lane.submit("anna", held.work()));
  EXPECT_FALSE(lane.submit("anna", held.work()));
  EXPECT_TRUE(lane.submit("ben", held.work()));
  EXPECT_TRUE(lane.submit("ben", held.work()));
  EXPECT_FALSE(lane.submit("ben", held.work()));
  EXPECT_FALSE(lane.submit("cleo", held.work()));
  held.let_go();
  lane.join();
}

TEST(Lanes, WhoHasLeastUnderWayIsNext) {
  Held first, second;
  std::mutex lock;
  std::vector<std::string> order;
  const auto note = [&](const std::string& name) {
    return [&, name] {
      const std::lock_guard guard(lock);
      order.push_back(name);
    };
  };
  WorkLane lane({.threads = 2, .places = 100, .places_each = 100});
  std::promise<void> anna_works, ben_works;
  const auto held = [&](Held& by, std::promise<void>& begun) {
    return [work = by.work(), &begun] {
      begun.set_value();
      work();
    };
  };
  ASSERT_TRUE(lane.submit("anna", held(first, anna_works)));
  ASSERT_TRUE(lane.submit("ben", held(second, ben_works)));
  anna_works.get_future().wait();
  ben_works.get_future().wait();
  for (const char* name : {"anna 1", "anna 2"}) lane.submit("anna", note(name));
  lane.submit("ben", note("ben 1"));
  lane.submit("cleo", note("cleo 1"));
  std::promise<void> all_done;
  lane.submit("anna", [&] { all_done.set_value(); });
  second.let_go();  // ben's is over, anna's goes on
  all_done.get_future().wait();
  first.let_go();
  lane.join();
  EXPECT_EQ(order, (std::vector<std::string>{"ben 1", "cleo 1", "anna 1", "anna 2"}));
}

TEST(Places, AreCountedInAllAndForEach) {
  Places places;
  EXPECT_TRUE(places.take("anna", 3, 2));
  EXPECT_TRUE(places.take("anna", 3, 2));
  EXPECT_FALSE(places.take("anna", 3, 2));
  EXPECT_TRUE(places.take("ben", 3, 2));
  EXPECT_FALSE(places.take("ben", 3, 2));
  places.give_back("anna");
  EXPECT_EQ(places.taken(), 2);
  EXPECT_TRUE(places.take("ben", 3, 2));
}

}  // namespace
}  // namespace talus::service
