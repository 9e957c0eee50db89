#pragma once
// One client: requests in, answers out. All of it happens in the thread of the sockets, which must never wait; handlers
// run in the threads of the lanes.

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "http/guard.hpp"
#include "http/hosts.hpp"
#include "http/lanes.hpp"
#include "http/response.hpp"

namespace talus::service {

class Connection;

/// The threads of the handlers.
struct Lanes {
  explicit Lanes(const Config& config);
  WorkLane operation, request, production, waiting;
  WorkLane large;  ///< for requests with a large body, whatever they ask for: parsed, it takes many times its size
};

/// What the connections share.
struct Front {
  const GuardLimits limits;
  const Hosts hosts;
  const std::size_t traffic_limit;  ///< [bytes] of bodies and answers in memory
  const std::chrono::milliseconds head_limit;
  const std::function<Admission(Incoming)> admit;
  Lanes& lanes;
  std::atomic<std::size_t> traffic{0};      ///< see traffic_limit
  std::list<Connection*> connections = {};  ///< also those that are closed, but whose handler is under way
  bool stopping = false;

  /// Closes, of the connections that `may` be closed, the one that gives way most readily, and of equals the one that
  /// has waited longest. @return false where there is none
  bool close_one(const std::function<bool(const Connection&)>& may);
};

/// Bytes counted in Front::traffic while this object exists.
class Charge {
 public:
  explicit Charge(Front& front) : front_(front) {}
  ~Charge() { front_.traffic -= bytes_; }
  Charge(const Charge&) = delete;
  Charge& operator=(const Charge&) = delete;
  void add(std::size_t bytes) {
    front_.traffic += bytes;
    bytes_ += bytes;
  }

 private:
  Front& front_;
  std::size_t bytes_ = 0;
};

class Connection : public std::enable_shared_from_this<Connection> {
 public:
  using Steady = std::chrono::steady_clock;

  /// @param front  outlives it
  /// @param spare  whether it is beyond the limits: only the operator's requests are answered
  Connection(Front& front, boost::asio::ip::tcp::socket socket, std::string remote, std::string local, bool spare);
  ~Connection();
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start();
  void close();
  /// The service stops: no further request; a handler is told.
  void stop();

  const std::string& remote() const { return remote_; }
  bool is_spare() const { return spare_; }
  bool is_open() const { return state_ != State::closed; }
  bool is_writing() const { return state_ == State::writing; }
  Steady::time_point since() const { return since_; }
  /// How readily it gives way to another: 3 while no request is under way, 2 while one is being received or answered, 1
  /// in the first second of either, 0 (never) while it is handled.
  int rank() const;

 private:
  enum class State { idle, head, body, handling, streaming, writing, lingering, closed };

  void enter(State state, std::chrono::milliseconds limit);
  void set_limit(std::chrono::milliseconds limit);
  void expired();

  void read();
  void receive();
  void take(std::string_view bytes);
  void end_of_input(bool broken);
  void take_requests();
  void take_head(std::size_t size);
  void begin_body();
  void add_to_body(std::string_view bytes);
  bool has_room_for_traffic();

  void handle();
  WorkLane& lane_for(Lane lane) const;
  std::function<void()> work();
  void pour(const Answer& answer, Framing framing, std::uint64_t turn, const std::stop_token& stop);
  bool deliver(std::uint64_t turn, std::string text);
  void work_is_done(std::uint64_t turn);

  void refuse(const Refusal& refusal);
  void answer(const Answer& answer);
  void send(std::string text, std::function<void(bool)> then);
  void answered();
  void linger();

  Front& front_;
  boost::asio::ip::tcp::socket socket_;
  boost::asio::steady_timer timer_;
  const std::string remote_, local_;
  const bool spare_;
  std::list<Connection*>::iterator place_;
  State state_ = State::idle;
  Steady::time_point since_ = Steady::now();  ///< of the state
  bool reading_ = false;                      ///< a read is under way
  bool ended_ = false;                        ///< the client sends no more
  std::string buffer_;                        ///< received, not yet taken
  std::string out_;                           ///< being sent

  // Of the request under way.
  std::uint64_t turn_ = 0;  ///< its number: what comes from the handler of another one is dropped
  Framing framing_;
  Admission admission_;
  std::size_t length_ = 0;  ///< of its body
  std::string body_;
  std::shared_ptr<Charge> charge_;
  std::stop_source stop_;

  /// Works of this connection in the lanes, and what keeps it alive for them: it ends in the thread of the sockets.
  int works_ = 0;
  std::shared_ptr<Connection> kept_;
};

}  // namespace talus::service
