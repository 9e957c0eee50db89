// What the guard lets through to the HTTP library.

#include <gtest/gtest.h>

#include "http/guard.hpp"

namespace talus::service {
namespace {

const GuardLimits limits{.head_bytes = 4000, .headers = 20, .target_bytes = 100, .body_bytes = 1000};

Head of(const std::string& line, const std::string& headers = "Host: a\r\n") {
  return judge(line + "\r\n" + headers + "\r\n", limits);
}
/// 0 where the header is valid.
int verdict(const std::string& head, const GuardLimits& by) {
  try {
    judge(head, by);
    return 0;
  } catch (const BadRequest& bad) {
    EXPECT_FALSE(bad.why.empty());
    return bad.status;
  }
}
int status(const std::string& line, const std::string& headers = "Host: a\r\n") {
  return verdict(line + "\r\n" + headers + "\r\n", limits);
}
int header_status(const std::string& header) { return status("GET / HTTP/1.1", "Host: a\r\n" + header + "\r\n"); }

TEST(Guard, AGoodRequestIsWrittenAnew) {
  const Head head = of("POST /jobs?x=1 HTTP/1.1",
                       "Host: a:80\r\nContent-Length: 5\r\nContent-Type: application/json\r\nRange: bytes=0-1,2-3\r\n"
                       "Cookie: c\r\nAccept-Encoding: gzip\r\nPrefer:  respond-async \r\nConnection: close\r\n");
  EXPECT_EQ(head.method, "POST");
  EXPECT_EQ(head.body, 5u);
  EXPECT_FALSE(head.keep_alive);
  EXPECT_EQ(head.rewritten,
            "POST /jobs?x=1 HTTP/1.1\r\nhost: a:80\r\nX-Body-Type: application/json\r\nprefer: respond-async\r\n"
            "Content-Length: 5\r\n\r\n");
}

TEST(Guard, TheEndOfTheHead) {
  EXPECT_EQ(head_end("GET / HTTP/1.1\r\n\r\nbody"), 18u);
  EXPECT_FALSE(head_end("GET / HTTP/1.1\r\n"));
  EXPECT_FALSE(head_end("GET / HTTP/1.1\n\n"));
}

TEST(Guard, RequestLines) {
  EXPECT_EQ(status("GET / HTTP/1.1"), 0);
  EXPECT_EQ(status("GET / HTTP/1.0", ""), 0);
  EXPECT_FALSE(of("GET / HTTP/1.0", "").keep_alive);
  EXPECT_EQ(status("GET / HTTP/2.0"), 505);
  EXPECT_EQ(status("GET /"), 400);
  EXPECT_EQ(status("GET  / HTTP/1.1"), 400);
  EXPECT_EQ(status("GET /\x01 HTTP/1.1"), 400);
  EXPECT_EQ(status("G@T / HTTP/1.1"), 400);
  EXPECT_EQ(status("GET /" + std::string(100, 'a') + " HTTP/1.1"), 414);
}

TEST(Guard, TargetsInAbsoluteForm) {  // RFC 9112 3.2.2: to be taken, and their authority stands for Host
  EXPECT_EQ(of("GET http://b:80/jobs?x=1 HTTP/1.1").rewritten,
            of("GET /jobs?x=1 HTTP/1.1", "Host: b:80\r\n").rewritten);
  EXPECT_EQ(of("GET HTTP://b/ HTTP/1.1").rewritten, of("GET / HTTP/1.1", "Host: b\r\n").rewritten);
  EXPECT_EQ(of("GET http://b HTTP/1.1").rewritten, of("GET / HTTP/1.1", "Host: b\r\n").rewritten);
  EXPECT_EQ(of("GET http://b?x=1 HTTP/1.1").rewritten, of("GET /?x=1 HTTP/1.1", "Host: b\r\n").rewritten);
  EXPECT_EQ(of("GET http://b/http://c/ HTTP/1.1").rewritten, of("GET /http://c/ HTTP/1.1", "Host: b\r\n").rewritten);
  EXPECT_EQ(of("GET http://b/ HTTP/1.0", "").rewritten, of("GET / HTTP/1.0", "Host: b\r\n").rewritten);
  for (const char* target : {"http:///jobs", "http://:80/jobs", "http://u@b/", "http://b%0d%0a/", "http://b,c/",
                             "http:/b", "http:", "https://b/", "ftp://b/", "b:80", "jobs", "http://b/\x01", "?x=1"})
    EXPECT_EQ(status("GET " + std::string(target) + " HTTP/1.1"), 400) << target;
  EXPECT_EQ(status("GET http://b/ HTTP/1.1", ""), 400);
  EXPECT_EQ(status("GET http://b/ HTTP/1.1", "Host: a/b\r\n"), 400);
  EXPECT_EQ(status("GET http://b/ HTTP/1.1", "Host: a\r\nHost: b\r\n"), 400);
  EXPECT_EQ(status("GET http://b/" + std::string(100, 'a') + " HTTP/1.1"), 414);
}

TEST(Guard, TheAsteriskIsForOptionsAlone) {  // RFC 9112 3.2.4
  EXPECT_EQ(of("OPTIONS * HTTP/1.1").rewritten, "OPTIONS * HTTP/1.1\r\nhost: a\r\nContent-Length: 0\r\n\r\n");
  EXPECT_EQ(of("OPTIONS http://a HTTP/1.1").rewritten, of("OPTIONS * HTTP/1.1").rewritten);
  EXPECT_EQ(of("OPTIONS http://a/ HTTP/1.1").rewritten, of("OPTIONS / HTTP/1.1").rewritten);
  EXPECT_EQ(status("OPTIONS ** HTTP/1.1"), 400);
  EXPECT_EQ(status("OPTIONS *?x HTTP/1.1"), 400);
  EXPECT_EQ(status("GET * HTTP/1.1"), 400);
}

TEST(Guard, FramingThatTwoReadersCouldTakeDifferently) {
  EXPECT_EQ(header_status("Transfer-Encoding: chunked"), 411);
  EXPECT_EQ(header_status("Transfer-Encoding: chunked\r\nContent-Length: 5"), 400);
  EXPECT_EQ(header_status("Content-Length: 5\r\nContent-Length: 5"), 400);
  EXPECT_EQ(header_status("Content-Length: +5"), 400);
  EXPECT_EQ(header_status("Content-Length: 0x5"), 400);
  EXPECT_EQ(header_status("Content-Length: -1"), 400);
  EXPECT_EQ(header_status("Content-Length: 1001"), 413);
  EXPECT_EQ(header_status("Content-Length: 99999999999999999999"), 413);
  EXPECT_EQ(header_status("Content-Length : 5"), 400);
  EXPECT_EQ(header_status("X: a\r\n folded"), 400);
  EXPECT_EQ(header_status("no colon"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1", ""), 400);
  EXPECT_EQ(status("GET / HTTP/1.1", "Host: a\r\nHost: b\r\n"), 400);
  EXPECT_EQ(status("GET / HTTP/1.1", "Host: a/b\r\n"), 400);
}

TEST(Guard, NumbersAndSizes) {
  std::string many = "Host: a\r\n";
  for (int i = 0; i < 19; ++i) many += "X: y\r\n";
  EXPECT_EQ(status("GET / HTTP/1.1", many), 0);
  EXPECT_EQ(status("GET / HTTP/1.1", many + "X: y\r\n"), 431);
  EXPECT_EQ(header_status("X: " + std::string(4000, 'a')), 431);
}

TEST(Guard, ControlCharactersBareOrHidden) {
  EXPECT_EQ(header_status("Accept: a\x01"), 400);
  EXPECT_EQ(header_status("Accept: a\nb: c"), 400);
  EXPECT_EQ(header_status("X-Request-Id: a%0d%0aSet-Cookie:%20b"), 400);
  EXPECT_EQ(header_status("Idempotency-Key: a%00"), 400);
  EXPECT_EQ(header_status("Idempotency-Key: a%u000d%u000aSet-Cookie:%20b"), 400);
  EXPECT_EQ(header_status("Content-Type: a%0D%0Ab"), 400);
  EXPECT_EQ(header_status("Idempotency-Key: 100%25"), 0);
  EXPECT_EQ(header_status("Referer: a%0d%0a"), 0);  // not handed on
  EXPECT_EQ(of("GET / HTTP/1.1", "Host: a\r\nReferer: a%0d%0a\r\n").rewritten.find("eferer"), std::string::npos);
}

TEST(Guard, NoRangeReachesTheLibrary) {
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 500; ++i) ranges += ",0-";
  const Head head = of("GET / HTTP/1.1", "Host: a\r\n" + ranges + "\r\n");
  EXPECT_EQ(head.rewritten.find("ange"), std::string::npos);
}

TEST(Guard, WithoutTokensOnlyLoopbackNamesAndNoOtherSites) {
  GuardLimits local = limits;
  local.loopback_names_only = true;
  const auto code = [&](const std::string& headers) { return verdict("GET / HTTP/1.1\r\n" + headers + "\r\n", local); };
  for (const char* host : {"localhost", "localhost:80", "127.0.0.1:8080", "[::1]:80"})
    EXPECT_EQ(code(std::string("Host: ") + host + "\r\n"), 0) << host;
  for (const char* host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil.example:80", "10.0.0.1"})
    EXPECT_EQ(code(std::string("Host: ") + host + "\r\n"), 403) << host;
  EXPECT_EQ(code("Host: localhost\r\nOrigin: https://evil.example\r\n"), 403);
  EXPECT_EQ(code("Host: localhost:80\r\nOrigin: http://localhost:80\r\n"), 0);

  const auto absolute = [&](const std::string& authority, const std::string& headers) {
    return verdict("GET http://" + authority + "/ HTTP/1.1\r\n" + headers + "\r\n", local);
  };
  EXPECT_EQ(absolute("localhost:80", "Host: localhost:80\r\n"), 0);
  EXPECT_EQ(absolute("[::1]:80", "Host: localhost\r\n"), 0);
  EXPECT_EQ(absolute("evil.example", "Host: localhost\r\n"), 403);
  EXPECT_EQ(absolute("localhost", "Host: evil.example\r\n"), 403);
  EXPECT_EQ(absolute("localhost.evil.example", "Host: localhost.evil.example\r\n"), 403);
  EXPECT_EQ(absolute("localhost:80", "Host: localhost:80\r\nOrigin: http://localhost:80\r\n"), 0);
  EXPECT_EQ(absolute("localhost:80", "Host: localhost:81\r\nOrigin: http://localhost:81\r\n"), 403);
}

}  // namespace
}  // namespace talus::service
