// Problems, routes, tokens, options.

#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <filesystem>
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
  using namespace reason;
  const std::vector<Reason> all = {bad_request,
                                   unauthorized,
                                   forbidden,
                                   not_found,
                                   no_such_process,
                                   no_such_job,
                                   result_not_ready,
                                   job_dismissed,
                                   method_not_allowed,
                                   conflict,
                                   length_required,
                                   too_large,
                                   uri_too_long,
                                   unsupported_media_type,
                                   unprocessable,
                                   quota,
                                   queue_full,
                                   headers_too_large,
                                   internal,
                                   unavailable,
                                   timeout,
                                   disk_full};
  for (const Reason& reason : all) {
    const Answer answer = problem(Refusal(reason, "why"), "");
    const Json body = Json::parse(answer.body);
    EXPECT_EQ(answer.status, reason.status);
    EXPECT_EQ(body["status"], answer.status);
    EXPECT_EQ(body["detail"], "why");
    types.insert(body["type"].get<std::string>());
  }
  EXPECT_EQ(types.size(), all.size());
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
  const Routes two = {{"POST", "/processes/{}/execution", Role::read, handler},
                      {"POST", "/processes/echo/execution", Role::read, handler}};
  EXPECT_EQ(find_route(two, "POST", "/processes/echo/execution").route, &two[1]);
  EXPECT_EQ(find_route(two, "POST", "/processes/echo/execution").allow, "POST, OPTIONS");
  EXPECT_EQ(find_route(two, "POST", "/processes/other/execution").route, &two[0]);
  const FoundRoute server = find_route(routes, "OPTIONS", "*");
  EXPECT_FALSE(server.route);
  EXPECT_EQ(server.allow, "GET, HEAD, DELETE, OPTIONS");
}

/// In base64 (RFC 4648 4).
std::string base64(const std::string& text) {
  std::string out(4 * ((text.size() + 2) / 3) + 1, '\0');
  EVP_EncodeBlock(reinterpret_cast<unsigned char*>(out.data()), reinterpret_cast<const unsigned char*>(text.data()),
                  static_cast<int>(text.size()));
  out.pop_back();
  return out;
}

TEST(Tokens, AreFoundByTheirHash) {
  const test::TemporaryDirectory directory;
  const auto [token, line] = new_token("submit", "anna");
  EXPECT_EQ(line.find(token), std::string::npos);
  std::ofstream(directory / "tokens") << "# people\n\n"
                                      << line << "\n"
                                      << new_token("read", "ben").second << " # ben\n";
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

TEST(Tokens, MayBeThePasswordOfBasic) {  // RFC 7617 2
  const test::TemporaryDirectory directory;
  const auto [token, line] = new_token("submit", "anna");
  std::ofstream(directory / "tokens") << line << "\n";
  const Tokens tokens(directory / "tokens");
  for (const char* user : {"anna", "", "an", "ann"}) {  // with every number of "=" at the end
    ASSERT_TRUE(tokens.find("Basic " + base64(user + (":" + token)))) << user;
    EXPECT_EQ(tokens.find("basic " + base64(user + (":" + token)))->subject, "anna");
  }
  for (const std::string& bad :
       std::vector<std::string>{"Basic", "Basic ", "Basic " + base64(token), "Basic " + base64("anna:" + token + "x"),
                                "Basic " + base64("anna:"), "Basic ====", "Basic a",
                                "Basic " + base64("anna:x:" + token), "Bearer " + base64("anna:" + token)})
    EXPECT_FALSE(tokens.find(bad)) << bad;
}

TEST(Tokens, Expire) {
  const test::TemporaryDirectory directory;
  const auto [token, line] = new_token("read", "anna", "2027-01-31T00:00:00Z");
  std::ofstream(directory / "tokens") << line << "\n";
  Milliseconds now = *utc_time("2027-01-30T23:59:59.999Z");
  const Tokens tokens(directory / "tokens", [&now] { return now; });
  EXPECT_TRUE(tokens.find("Bearer " + token));
  ++now;
  EXPECT_FALSE(tokens.find("Bearer " + token));
}

TEST(Tokens, AreReadAgainUnlessTheFileIsWrong) {
  const test::TemporaryDirectory directory;
  const auto [old_token, old_line] = new_token("submit", "anna");
  const auto [token, line] = new_token("submit", "anna");
  std::ofstream(directory / "tokens") << old_line << "\n";
  Tokens tokens(directory / "tokens");
  std::ofstream(directory / "tokens") << "nonsense\n";
  EXPECT_THROW(tokens.reload(), TokensError);
  EXPECT_TRUE(tokens.find("Bearer " + old_token));
  std::ofstream(directory / "tokens") << line << "\n";
  tokens.reload();
  EXPECT_FALSE(tokens.find("Bearer " + old_token));
  EXPECT_TRUE(tokens.find("Bearer " + token));
}

TEST(Tokens, ABadFileIsRefused) {
  const test::TemporaryDirectory directory;
  const std::string good = "submit anna " + std::string(64, 'a');
  const auto refused = [&](const std::string& text) {
    std::ofstream(directory / "tokens") << text;
    EXPECT_THROW(Tokens(directory / "tokens"), TokensError) << text;
  };
  refused("");
  refused("submit anna secret\n");
  refused("submit\n");
  refused("admin anna " + std::string(64, 'a') + "\n");
  refused("submit a/b " + std::string(64, 'a') + "\n");
  refused(good + " tomorrow\n");
  refused(good + " 2027-01-31T00:00:00Z x\n");
  EXPECT_THROW(Tokens(directory / "none"), IoError);
  EXPECT_THROW(new_token("submit", "a b"), TokensError);
  EXPECT_THROW(new_token("submit", "anna", "2027"), TokensError);
  std::ofstream(directory / "tokens") << good << "\n";
  EXPECT_NO_THROW(Tokens(directory / "tokens"));
  std::filesystem::permissions(directory / "tokens", std::filesystem::perms::others_write,
                               std::filesystem::perm_options::add);
  EXPECT_THROW(Tokens(directory / "tokens"), TokensError);
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
  EXPECT_EQ(options({"--data", "d", "--talus", "/bin/true", "--listen", "127.evil:80"}).exit, 2);
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
