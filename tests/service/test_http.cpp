// Problems, routes, tokens, options.

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "base/digest.hpp"
#include "http/message.hpp"
#include "http/service.hpp"
#include "http/tokens.hpp"
#include "options.hpp"
#include "queue/database.hpp"
#include "temporary_directory.hpp"

namespace talus::service {
namespace {

TEST(Problem, EveryReasonHasItsType) {
  std::set<std::string> types;
  for (const Reason* reason : reason::all) {
    const Answer answer = problem(Refusal(*reason, "why"), "");
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(answer.status, reason->status);
    EXPECT_EQ(body["status"], answer.status);
    EXPECT_EQ(body["detail"], "why");
    types.insert(body["type"].get<std::string>());
  }
  EXPECT_EQ(types.size(), std::size(reason::all));
}

TEST(Problem, MediaTypeFollowsTheClient) {
  const Refusal refusal(reason::no_such_job, "x", {{"/a", "b"}});
  EXPECT_EQ(problem(refusal, "*/*").type, "application/json");
  const Answer answer = problem(refusal, "application/problem+json, application/json");
  EXPECT_EQ(answer.type, "application/problem+json");
  EXPECT_EQ(answer.status, 404);
  const Json body = Json::parse(answer.body);
  EXPECT_EQ(body["type"], "http://www.opengis.net/def/exceptions/ogcapi-processes-1/1.0/no-such-job");
  EXPECT_EQ(body["errors"], Json::parse(R"([{"pointer": "/a", "message": "b"}])"));
}

TEST(Problem, StorageAndTheUnexpected) {
  const auto status = [](auto thrown) { return problem(std::make_exception_ptr(thrown), "").status; };
  EXPECT_EQ(status(StorageError("x", true)), 507);
  EXPECT_EQ(status(StorageError("x")), 503);
  const Answer internal = problem(std::make_exception_ptr(std::runtime_error("secret /path")), "");
  EXPECT_EQ(internal.status, 500);
  EXPECT_EQ(internal.body.find("secret"), std::string::npos);
}

TEST(Routes, AreFoundByMethodAndPath) {
  const Handler handler = [](Exchange&) { return Answer{}; };
  const Routes routes = {{"GET", "/", Role::read, handler},
                         {"GET", "/jobs/{}", Role::read, handler},
                         {"DELETE", "/jobs/{}", Role::submit, handler}};
  EXPECT_EQ(find_route(routes, "GET", "/").route, &routes[0]);
  EXPECT_EQ(find_route(routes, "GET", "/jobs/a").route, &routes[1]);
  EXPECT_EQ(find_route(routes, "GET", "/jobs/a").captured, (std::vector<std::string>{"a"}));
  EXPECT_EQ(find_route(routes, "HEAD", "/jobs/a").route, &routes[1]);
  EXPECT_EQ(find_route(routes, "GET", "/jobs/a/").route, &routes[1]);
  EXPECT_EQ(find_route(routes, "DELETE", "/jobs/a").route, &routes[2]);
  const FoundRoute wrong = find_route(routes, "PUT", "/jobs/a");
  EXPECT_FALSE(wrong.route);
  EXPECT_EQ(wrong.allow, "GET, HEAD, DELETE, OPTIONS");
  EXPECT_EQ(find_route(routes, "GET", "/jobs/a/b").allow, "");
  EXPECT_EQ(find_route(routes, "GET", "/jobs").allow, "");
  const FoundRoute server = find_route(routes, "OPTIONS", "*");
  EXPECT_FALSE(server.route);
  EXPECT_EQ(server.allow, "GET, HEAD, DELETE, OPTIONS");
}

TEST(Tokens, AreFoundByTheirHash) {
  const test::TemporaryDirectory directory;
  const auto [token, line] = new_token("submit", "anna");
  EXPECT_EQ(line.find(token), std::string::npos);
  std::ofstream(directory / "tokens") << "# people\n" << line << "\n" << new_token("read", "ben").second << " # ben\n";
  const Tokens tokens(directory / "tokens");
  ASSERT_TRUE(tokens.find("Bearer " + token));
  EXPECT_EQ(tokens.find("Bearer " + token)->subject, "anna");
  EXPECT_EQ(tokens.find("Bearer " + token)->role, Role::submit);
  for (const char* scheme : {"bearer ", "BEARER ", "bEaReR ", "Bearer  "})  // RFC 9110 11.1, 11.4
    EXPECT_TRUE(tokens.find(scheme + token)) << scheme;
  for (const std::string& bad :
       std::vector<std::string>{"", token, "Bearer " + token + " ", "Bearer" + token, "Bearer\t" + token, "Bearer",
                                "Bearer ", "Basic " + token, " Bearer " + token, "Bearer x"})
    EXPECT_FALSE(tokens.find(bad)) << bad;
}

TEST(Tokens, ABadFileIsRefused) {
  const test::TemporaryDirectory directory;
  const auto refused = [&](const std::string& text) {
    std::ofstream(directory / "tokens") << text;
    EXPECT_THROW(Tokens(directory / "tokens"), std::runtime_error) << text;
  };
  refused("");
  refused("submit anna secret\n");
  refused("admin anna " + std::string(64, 'a') + "\n");
  refused("submit a/b " + std::string(64, 'a') + "\n");
  EXPECT_THROW(Tokens(directory / "none"), std::runtime_error);
  EXPECT_THROW(new_token("submit", "a b"), std::runtime_error);
}

TEST(Digest, KnownValues) {  // FIPS 180-2, appendix B.1
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_TRUE(equal_in_constant_time("ab", "ab"));
  EXPECT_FALSE(equal_in_constant_time("ab", "ac"));
  EXPECT_FALSE(equal_in_constant_time("ab", "abc"));
  EXPECT_NE(random_hex(8), random_hex(8));
}

Options options(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "talusd");
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  return read_options(static_cast<int>(argv.size()), argv.data());
}

TEST(Options, OtherThanLoopbackNeedsTokens) {
  EXPECT_FALSE(options({"--data", "d", "--talus", "/bin/true"}).exit);
  EXPECT_FALSE(options({"--data", "d", "--talus", "/bin/true", "--listen", "[::1]:0"}).exit);
  EXPECT_EQ(options({"--data", "d", "--talus", "/bin/true", "--listen", "0.0.0.0:80"}).exit, 2);
  EXPECT_FALSE(options({"--data", "d", "--talus", "/bin/true", "--listen", "0.0.0.0:80", "--tokens", "t"}).exit);
  EXPECT_EQ(options({"--talus", "/bin/true"}).exit, 2);
  EXPECT_EQ(options({"--data", "d", "--talus", "/none"}).exit, 2);
  EXPECT_EQ(options({"--data", "d", "--talus", "/bin/true", "--listen", "127.0.0.1:99999"}).exit, 2);
  EXPECT_EQ(options({"--data", "d", "--workers", "0"}).exit, 2);
}

TEST(Options, AFileSaysTheSame) {
  const test::TemporaryDirectory directory;
  std::ofstream(directory / "talusd.conf")
      << "data = \"/d\"\nworkers = 3\nlisten = \"127.0.0.1:9\"\ntalus = \"/bin/true\"\n";
  const Options read = options({"--config", directory / "talusd.conf", "--workers", "4"});
  EXPECT_FALSE(read.exit);
  EXPECT_EQ(read.config.data, "/d");
  EXPECT_EQ(read.config.port, 9);
  EXPECT_EQ(read.config.workers, 4);
}

}  // namespace
}  // namespace talus::service
