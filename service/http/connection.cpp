#include "http/connection.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <future>
#include <thread>

#include "base/json.hpp"

namespace talus::service {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr milliseconds idle_limit{5000};    ///< between two requests
constexpr milliseconds write_limit{20000};  ///< for the client to accept the response, besides least_rate
constexpr milliseconds first_second{1000};  ///< see rank()
constexpr milliseconds linger_limit{500}, refused_body_limit{2000};
constexpr std::size_t least_rate = 256 << 10;      ///< of bodies and answers [bytes/s]
constexpr std::size_t most_read_ahead = 16 << 10;  ///< of the next request while one is handled

/// Gives the memory of a string back, which assigning {} does not.
void release(std::string& text) { std::string().swap(text); }

milliseconds time_for(std::size_t bytes) { return milliseconds(1000 * bytes / least_rate); }

Refusal overloaded(const std::string& what) { return {reason::unavailable, what + "; try again", {}, 2}; }

}  // namespace

bool Front::close_one(const std::function<bool(const Connection&)>& may) {
  Connection* first = nullptr;
  for (Connection* one : connections) {
    const int rank = one->rank();
    if (rank == 0 || !may(*one)) continue;
    if (!first || rank > first->rank() || (rank == first->rank() && one->since() < first->since())) first = one;
  }
  if (first) first->close();
  return first != nullptr;
}

Connection::Connection(Front& front, boost::asio::ip::tcp::socket socket, std::string remote, std::string local,
                       bool spare)
    : front_(front),
      socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      remote_(std::move(remote)),
      local_(std::move(local)),
      spare_(spare),
      place_(front.connections.insert(front.connections.end(), this)) {}

Connection::~Connection() { front_.connections.erase(place_); }

int Connection::rank() const {
  const bool fresh = Steady::now() - since_ < first_second;
  switch (state_) {
    case State::idle:
    case State::head:
    case State::lingering:
      return fresh ? 1 : 3;
    case State::body:
    case State::writing:
      return fresh ? 1 : 2;
    default:
      return 0;
  }
}

void Connection::start() {
  enter(State::idle, idle_limit);
  read();
}

void Connection::close() {
  if (state_ == State::closed) return;
  state_ = State::closed;
  ++turn_;
  stop_.request_stop();
  charge_.reset();
  boost::system::error_code ignored;
  timer_.cancel(ignored);
  socket_.close(ignored);
}

void Connection::stop() {
  framing_.keep_alive = false;
  stop_.request_stop();
  if (state_ != State::handling && state_ != State::streaming && state_ != State::writing) close();
}

void Connection::enter(State state, milliseconds limit) {
  state_ = state;
  since_ = Steady::now();
  set_limit(limit);
}

void Connection::set_limit(milliseconds limit) {
  timer_.expires_after(limit);
  timer_.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
    if (!error && self->timer_.expiry() <= Steady::now()) self->expired();
  });
}

void Connection::expired() {
  switch (state_) {
    case State::head:
    case State::body:
      return refuse({reason::request_timeout, "the request was not received completely in time"});
    case State::handling:
      stop_.request_stop();
      return refuse({reason::timeout, "the answer took too long"});
    default:
      return close();
  }
}

// In.

void Connection::read() {
  if (reading_ || ended_ || !is_open()) return;
  reading_ = true;
  socket_.async_wait(boost::asio::ip::tcp::socket::wait_read,
                     [self = shared_from_this()](const boost::system::error_code& error) {
                       self->reading_ = false;
                       if (!error && self->is_open()) self->receive();
                     });
}

void Connection::receive() {
  thread_local std::array<char, 65536> block;
  const std::size_t most = state_ == State::body ? std::min(block.size(), length_ - body_.size()) : most_read_ahead;
  const ssize_t got = ::recv(socket_.native_handle(), block.data(), most, MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return read();
  if (got <= 0) return end_of_input(got < 0);
  take({block.data(), static_cast<std::size_t>(got)});
}

void Connection::take(std::string_view bytes) {
  switch (state_) {
    case State::lingering:
      return read();  // what comes now is of no use
    case State::body:
      return add_to_body(bytes);
    default:
      buffer_.append(bytes);
  }
  if (state_ == State::idle || state_ == State::head) return take_requests();
  if (buffer_.size() < most_read_ahead) read();  // to notice that the client leaves
}

/// A client that closes and one that only sends no more look the same: of short work it still gets the answer.
/// @param broken  it is gone
void Connection::end_of_input(bool broken) {
  ended_ = true;
  if (state_ != State::handling && state_ != State::streaming && state_ != State::writing) return close();
  if (broken || admission_.lane == Lane::production || admission_.lane == Lane::waiting) stop_.request_stop();
}

void Connection::take_requests() {
  while (buffer_.starts_with("\r\n")) buffer_.erase(0, 2);  // RFC 9112 2.2
  if (buffer_.empty()) return read();
  if (state_ == State::idle) enter(State::head, front_.head_limit);
  framing_ = {};
  try {
    if (const auto end = head_end(buffer_)) return take_head(*end);
    if (buffer_.size() > front_.limits.head_bytes)
      throw Refusal(reason::headers_too_large,
                    "the request header is longer than " + std::to_string(front_.limits.head_bytes) + " bytes");
  } catch (const Refusal& refusal) {
    return refuse(refusal);
  }
  read();
}

/// A refused request with a body ends the connection: the body is not read.
void Connection::take_head(std::size_t size) {
  Head head = judge(std::string_view(buffer_).substr(0, size), front_.limits);
  buffer_.erase(0, size);
  length_ = head.body;
  framing_ = {.body = head.request.method != "HEAD", .chunks = head.chunks, .keep_alive = head.keep_alive};
  front_.hosts.check(head, local_);
  admission_ = front_.admit(std::move(head.request));
  if (spare_ && admission_.lane != Lane::immediate && admission_.lane != Lane::operation)
    return refuse(overloaded("there are too many connections"));
  if (admission_.refusal) {
    if (length_ > 0) framing_.keep_alive = false;
    return answer(*admission_.refusal);
  }
  if (!head.expects_continue || buffer_.size() >= length_) return begin_body();
  send("HTTP/1.1 100 Continue\r\n\r\n",
       [self = shared_from_this()](bool good) { good ? self->begin_body() : self->close(); });
}

void Connection::begin_body() {
  enter(State::body, front_.head_limit + time_for(length_));
  body_.clear();
  charge_ = std::make_shared<Charge>(front_);
  const std::string begun = buffer_.substr(0, length_);
  buffer_.erase(0, begun.size());
  add_to_body(begun);
}

void Connection::add_to_body(std::string_view bytes) {
  charge_->add(bytes.size());
  if (!bytes.empty() && !has_room_for_traffic()) return refuse(overloaded("too many large requests are under way"));
  try {
    if (body_.size() + bytes.size() > body_.capacity())
      body_.reserve(std::min(length_, 2 * (body_.size() + bytes.size())));
    body_.append(bytes);
  } catch (const std::bad_alloc&) {
    release(body_);
    return refuse(overloaded("there is no memory for this request"));
  }
  if (body_.size() == length_) return handle();
  read();
}

/// Closes clients that do not read their answers, where too much is in memory. @return false where it still is
bool Connection::has_room_for_traffic() {
  while (front_.traffic > front_.traffic_limit)
    if (!front_.close_one([](const Connection& one) { return one.is_writing(); })) return false;
  return true;
}

// To the handlers and back.

void Connection::handle() {
  stop_ = {};
  ++turn_;
  enter(State::handling, admission_.limit);
  if (admission_.lane == Lane::immediate) return answer(admission_.handle({}, {}));
  read();
  WorkLane& lane = lane_for(admission_.lane);
  const std::string subject = admission_.subject;
  kept_ = shared_from_this();
  ++works_;
  bool accepted = false;
  try {
    accepted = lane.submit(subject, work());
  } catch (const std::bad_alloc&) {
  }
  if (accepted) return;
  refuse(overloaded("too many requests are under way"));
  work_is_done(turn_);
}

WorkLane& Connection::lane_for(Lane lane) const {
  if (length_ > large_body) return front_.lanes.large;
  switch (lane) {
    case Lane::operation:
      return front_.lanes.operation;
    case Lane::production:
      return front_.lanes.production;
    case Lane::waiting:
      return front_.lanes.waiting;
    default:
      return front_.lanes.request;
  }
}

/// What a thread of a lane does for the request.
std::function<void()> Connection::work() {
  return [this, turn = turn_, handler = std::move(admission_.handle), body = std::move(body_), charge = charge_,
          stop = stop_.get_token(), framing = framing_]() mutable {
    const auto serve = [&] {
      if (stop.stop_requested()) return;  // the client has left meanwhile
      Answer answer;
      try {
        answer = handler(std::move(body), stop);
      } catch (const std::exception&) {  // even the problem document could not be made
        answer = problem(overloaded("there is no memory for this request"), "");
      }
      charge.reset();
      if (answer.stream) return pour(answer, framing, turn, stop);
      boost::asio::post(socket_.get_executor(), [this, turn, given = std::move(answer)] {
        if (turn == turn_) this->answer(given);
      });
    };
    for (bool served = false;; std::this_thread::sleep_for(milliseconds(100))) try {
        if (!served) serve();
        served = true;
        handler = nullptr;
        return boost::asio::post(socket_.get_executor(), [this, turn] { work_is_done(turn); });
      } catch (const std::exception&) {  // there is no memory: the connection ends, once there is some for saying so
        served = true;
      }
  };
}

/// A stream, from its head to its end. Called in the thread of a lane.
void Connection::pour(const Answer& answer, Framing framing, std::uint64_t turn, const std::stop_token& stop) {
  if (!framing.chunks) framing.keep_alive = false;  // the end of the connection is that of the stream
  if (!deliver(turn, response_text(answer, framing))) return;
  answer.stream([&](const std::string& piece) {
    return !stop.stop_requested() && deliver(turn, stream_piece(piece, framing.chunks));
  });
  if (framing.chunks) deliver(turn, last_chunk);
  boost::asio::post(socket_.get_executor(), [this, turn, again = framing.keep_alive] {
    if (turn != turn_) return;
    framing_.keep_alive = framing_.keep_alive && again;
    answered();
  });
}

/// Sends a piece of a stream. Called in the thread of a lane; waits. @return whether it has been sent
bool Connection::deliver(std::uint64_t turn, std::string text) {
  const auto sent = std::make_shared<std::promise<bool>>();
  std::future<bool> result = sent->get_future();
  boost::asio::post(socket_.get_executor(), [this, turn, text = std::move(text), sent]() mutable {
    if (turn != turn_) return sent->set_value(false);
    enter(State::streaming, write_limit + time_for(text.size()));
    send(std::move(text), [self = shared_from_this(), sent](bool good) {
      if (good) self->set_limit(self->admission_.limit);
      sent->set_value(good);
    });
  });
  return result.get();
}

/// A handler that has not answered, since its client has left or memory is short, ends the connection.
void Connection::work_is_done(std::uint64_t turn) {
  if (turn == turn_ && (state_ == State::handling || state_ == State::streaming)) close();
  if (--works_ == 0) kept_.reset();
}

// Out.

void Connection::refuse(const Refusal& refusal) {
  log_info("refused", {{"status", refusal.reason.status}, {"why", refusal.what()}});
  framing_.keep_alive = false;
  answer(problem(refusal, ""));
}

void Connection::answer(const Answer& given) {
  ++turn_;
  if (front_.stopping) framing_.keep_alive = false;
  release(body_);
  std::string text = response_text(given, framing_);
  charge_ = std::make_shared<Charge>(front_);
  charge_->add(text.size());
  has_room_for_traffic();  // before this answer counts as one that is not read
  enter(State::writing, write_limit + time_for(text.size()));
  send(std::move(text), [self = shared_from_this()](bool good) { good ? self->answered() : self->close(); });
}

/// @param then  told whether all of it was accepted
void Connection::send(std::string text, std::function<void(bool)> then) {
  if (!out_.empty()) return close();  // the client does not even take a 100 Continue
  out_ = std::move(text);
  boost::asio::async_write(
      socket_, boost::asio::buffer(out_),
      [self = shared_from_this(), then = std::move(then)](const boost::system::error_code& error, std::size_t) {
        release(self->out_);
        then(!error && self->is_open());
      });
}

void Connection::answered() {
  charge_.reset();
  admission_ = {};
  ++turn_;
  if (!framing_.keep_alive || ended_) return linger();
  enter(State::idle, idle_limit);
  take_requests();
}

/// Closes the sending side and keeps reading for a moment, so that the client receives the last response.
void Connection::linger() {
  boost::system::error_code ignored;
  socket_.shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  if (ended_) return close();
  release(buffer_);
  enter(State::lingering, length_ > 0 ? refused_body_limit : linger_limit);
  read();
}

}  // namespace talus::service
