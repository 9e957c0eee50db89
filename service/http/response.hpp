#pragma once
// Answers as bytes.

#include <string>

#include "http/message.hpp"

namespace talus::service {

/// What a response depends on besides its answer.
struct Framing {
  bool body = true;    ///< false: the request was HEAD
  bool chunks = true;  ///< the client understands chunked content
  bool keep_alive = true;
};

/// The head, and the body where the answer has one and is no stream.
std::string response_text(const Answer& answer, const Framing& framing);

/// A piece of a stream, and its end.
std::string stream_piece(const std::string& text, bool chunks);
inline constexpr const char* last_chunk = "0\r\n\r\n";

}  // namespace talus::service
