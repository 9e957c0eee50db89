// What the guard takes for a request, and from whom.

#include <gtest/gtest.h>

#include "http/guard.hpp"
#include "http/hosts.hpp"

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
  } catch (const Refusal& refusal) {
    EXPECT_STRNE(refusal.what(), "");
    return refusal.reason.status;
  }
}
int status(const std::string& line, const std::string& headers = "Host: a\r\n") {
  return verdict(line + "\r\n" + headers + "\r\n", limits);
}
int header_status(const std::string& header) { return status("GET / HTTP/1.1", "Host: a\r\n" + header + "\r\n"); }

/// All that handlers see of a request, as one text.
std::string seen(const Head& head) {
  std::string text = head.request.method + " " + head.request.path;
  for (const auto& [name, value] : head.request.query) text += " [" + name + "=" + value + "]";
  for (const auto& [name, value] : head.request.headers) text += "\n" + name + ": " + value;
  return text;
}

TEST(Guard, AGoodRequest) {
  const Head head = of("POST /jobs?x=1 HTTP/1.1",
                       "Host: a:80\r\nContent-Length: 5\r\nContent-Type: application/json\r\nRange: bytes=0-1,2-3\r\n"
                       "Cookie: c\r\nAccept-Encoding: gzip\r\nPrefer:  respond-async \r\nConnection: close\r\n");
  EXPECT_EQ(head.request.method, "POST");
  EXPECT_EQ(head.body, 5u);
  EXPECT_FALSE(head.keep_alive);
  EXPECT_TRUE(head.chunks);
  EXPECT_EQ(seen(head), "POST /jobs [x=1]\ncontent-type: application/json\nhost: a:80\nprefer: respond-async");
}

TEST(Guard, CodesInTheTarget) {  // RFC 3986 2.1; in a query "+" is a blank, too
  EXPECT_EQ(seen(of("GET /a%20b%2Fc?d=e+f%2b&g&h=i=%&=j#k HTTP/1.1")),
            "GET /a b/c [=j] [d=e f+] [g=] [h=i=%]\nhost: a");
  EXPECT_EQ(of("GET /a+b%zz%4 HTTP/1.1").request.path, "/a+b%zz%4");
}

TEST(Guard, ListsAreJoined) {
  EXPECT_EQ(of("GET / HTTP/1.1", "Host: a\r\nPrefer: b\r\nPrefer: c\r\n").request.header("prefer"), "b, c");
  EXPECT_EQ(header_status("Authorization: b\r\nAuthorization: c"), 400);
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
  EXPECT_EQ(seen(of("GET http://b:80/jobs?x=1 HTTP/1.1")), seen(of("GET /jobs?x=1 HTTP/1.1", "Host: b:80\r\n")));
  EXPECT_EQ(seen(of("GET HTTP://b/ HTTP/1.1")), seen(of("GET / HTTP/1.1", "Host: b\r\n")));
  EXPECT_EQ(seen(of("GET http://b HTTP/1.1")), seen(of("GET / HTTP/1.1", "Host: b\r\n")));
  EXPECT_EQ(seen(of("GET http://b?x=1 HTTP/1.1")), seen(of("GET /?x=1 HTTP/1.1", "Host: b\r\n")));
  EXPECT_EQ(seen(of("GET http://b/http://c/ HTTP/1.1")), seen(of("GET /http://c/ HTTP/1.1", "Host: b\r\n")));
  EXPECT_EQ(seen(of("GET http://b/ HTTP/1.0", "")), seen(of("GET / HTTP/1.0", "Host: b\r\n")));
  for (const char* target : {"http:///jobs", "http://:80/jobs", "http://u@b/", "http://b%0d%0a/", "http://b,c/",
                             "http:/b", "http:", "https://b/", "ftp://b/", "b:80", "jobs", "http://b/\x01", "?x=1"})
    EXPECT_EQ(status("GET " + std::string(target) + " HTTP/1.1"), 400) << target;
  EXPECT_EQ(status("GET http://b/ HTTP/1.1", ""), 400);
  EXPECT_EQ(status("GET http://b/ HTTP/1.1", "Host: a/b\r\n"), 400);
  EXPECT_EQ(status("GET http://b/ HTTP/1.1", "Host: a\r\nHost: b\r\n"), 400);
  EXPECT_EQ(status("GET http://b/" + std::string(100, 'a') + " HTTP/1.1"), 414);
}

TEST(Guard, TheAsteriskIsForOptionsAlone) {  // RFC 9112 3.2.4
  EXPECT_EQ(seen(of("OPTIONS * HTTP/1.1")), "OPTIONS *\nhost: a");
  EXPECT_EQ(seen(of("OPTIONS http://a HTTP/1.1")), seen(of("OPTIONS * HTTP/1.1")));
  EXPECT_EQ(seen(of("OPTIONS http://a/ HTTP/1.1")), seen(of("OPTIONS / HTTP/1.1")));
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
  EXPECT_EQ(status("GET / HTTP/1.1", "Host:\r\nHost: b\r\n"), 400);
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
  EXPECT_EQ(seen(of("GET / HTTP/1.1", "Host: a\r\nReferer: a%0d%0a\r\n")), "GET /\nhost: a");
}

TEST(Guard, NoOtherHeaderIsHandedOn) {
  std::string ranges = "Range: bytes=0-";
  for (int i = 0; i < 500; ++i) ranges += ",0-";
  EXPECT_EQ(seen(of("GET / HTTP/1.1", "Host: a\r\n" + ranges + "\r\n")), "GET /\nhost: a");
}

/// The status for a request with these headers under a configuration, from a client that has connected to `local`.
int site_status(const Config& config, const std::string& headers, const std::string& local = "127.0.0.1",
                const std::string& target = "/") {
  Head head = of("GET " + target + " HTTP/1.1", headers);
  try {
    Hosts(config).check(head, local);
    return 200;
  } catch (const Refusal& refusal) {
    return refusal.reason.status;
  }
}

TEST(Hosts, LoopbackNamesAreKnown) {
  const Config config;
  for (const char* host : {"localhost", "LOCALHOST:80", "127.0.0.1:8080", "[::1]:80", "[::1]"})
    EXPECT_EQ(site_status(config, std::string("Host: ") + host + "\r\n"), 200) << host;
  for (const char* host : {"evil.example", "127.0.0.1.evil.example", "localhost.evil.example:80", "10.0.0.1", "[::2]",
                           "localhost:1:2", "localhost:x", "localhost:123456"})
    EXPECT_EQ(site_status(config, std::string("Host: ") + host + "\r\n"), 403) << host;
  const auto absolute = [&](const std::string& authority, const std::string& headers) {
    return site_status(config, headers, "127.0.0.1", "http://" + authority + "/");
  };
  EXPECT_EQ(absolute("localhost:80", "Host: localhost:80\r\n"), 200);
  EXPECT_EQ(absolute("[::1]:80", "Host: localhost\r\n"), 200);
  EXPECT_EQ(absolute("evil.example", "Host: localhost\r\n"), 403);
  EXPECT_EQ(absolute("localhost", "Host: evil.example\r\n"), 403);
  EXPECT_EQ(absolute("localhost.evil.example", "Host: localhost.evil.example\r\n"), 403);
}

Config published(const std::string& url, const std::string& tokens = "") {
  Config config;
  config.public_url = url;
  config.tokens = tokens;
  return config;
}

TEST(Hosts, ConfiguredNamesAreKnownToo) {
  Config config = published("https://Talus.example.org/x", "tokens");
  config.hosts = {"second.example"};
  for (const char* host : {"talus.example.org", "second.example:81", "localhost", "192.0.2.7:80"})
    EXPECT_EQ(site_status(config, std::string("Host: ") + host + "\r\n", "192.0.2.7"), 200) << host;
  for (const char* host : {"evil.example", "192.0.2.8", "talus.example.org.evil.example"})
    EXPECT_EQ(site_status(config, std::string("Host: ") + host + "\r\n", "192.0.2.7"), 403) << host;
}

TEST(Hosts, TheNameIsWrittenAnew) {
  Head head = of("GET / HTTP/1.1", "Host: LocalHost:81\r\n");
  Hosts(Config{}).check(head, "127.0.0.1");
  EXPECT_EQ(head.request.header("host"), "localhost:81");
}

TEST(Hosts, PagesOfOtherSitesAreRefusedInEveryConfiguration) {
  const Config local, behind_proxy = published("https://talus.example.org"),
                      both = published("https://talus.example.org", "tokens");
  const std::string here = "Host: localhost:80\r\n";
  for (const Config& config : {local, behind_proxy, both}) {
    for (const char* origin : {"https://evil.example", "null", "http://localhost:81", "http://localhost"})
      EXPECT_EQ(site_status(config, here + "Origin: " + origin + "\r\n"), 403) << origin;
    for (const char* site : {"cross-site", "same-site"})
      EXPECT_EQ(site_status(config, here + "Sec-Fetch-Site: " + site + "\r\n"), 403) << site;
    for (const char* site : {"same-origin", "none"})
      EXPECT_EQ(site_status(config, here + "Sec-Fetch-Site: " + site + "\r\n"), 200) << site;
    EXPECT_EQ(site_status(config, here + "Origin: http://localhost:80\r\n"), 200);
    EXPECT_EQ(site_status(config, "Host: evil.example\r\n"), 403);
  }
  EXPECT_EQ(site_status(both, here + "Origin: https://talus.example.org\r\n"), 200);
  EXPECT_EQ(
      site_status(local, "Host: localhost:81\r\nOrigin: http://localhost:81\r\n", "127.0.0.1", "http://localhost:80/"),
      403);
}

TEST(Hosts, LoopbackIsAnAddressAndNoBeginningOfAName) {
  for (const char* address : {"localhost", "127.0.0.1", "127.1.2.3", "::1"})
    EXPECT_TRUE(is_loopback(address)) << address;
  for (const char* address : {"127.evil", "127.0.0.1.evil.example", "0.0.0.0", "128.0.0.1", "::", "localhost.evil", ""})
    EXPECT_FALSE(is_loopback(address)) << address;
}

}  // namespace
}  // namespace talus::service
