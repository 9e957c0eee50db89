#include <gtest/gtest.h>

#include "jobs/inputs.hpp"

namespace talus::service {
namespace {

template <class Read>
std::string pointers(Read read) {
  std::string all;
  try {
    read();
  } catch (const Refusal& e) {
    for (const Fault& fault : e.faults) all += fault.pointer + " ";
  }
  return all;
}
std::string study_faults(const char* text) {
  return pointers([&] { read_study_inputs(Json::parse(text)); });
}
std::string echo_faults(const char* text) {
  return pointers([&] { read_echo_inputs(Json::parse(text)); });
}

TEST(StudyInputs, OptionsGoIntoTheStudy) {
  const StudyInputs in = read_study_inputs(Json::parse(
      R"({"case": {"value": {"title": "t", "study": {"seed": 1}}}, "realizations": {"value": 5}, "seed": 7,
          "noise_floor_replicates": 2, "max_failed_share": 0.5, "histogram_edges_m": [1, 2],
          "quantity": "front_mass_99_m"})"));
  EXPECT_EQ(in.document["study"], Json::parse(R"({"seed": 7, "realizations": 5, "noise_floor_replicates": 2,
                                                  "max_failed_share": 0.5, "histogram_edges_m": [1, 2]})"));
  EXPECT_EQ(in.quantity, "front_mass_99_m");
}

TEST(StudyInputs, EveryFaultIsTold) {
  EXPECT_EQ(study_faults("{}"), "/inputs/case ");
  EXPECT_EQ(study_faults(R"({"case": 1, "realizations": 0, "seed": -1, "noise_floor_replicates": 1.5, "nonsense": 1,
                             "max_failed_share": 2, "histogram_edges_m": 3, "quantity": 4})"),
            "/inputs/nonsense /inputs/case /inputs/realizations /inputs/seed /inputs/noise_floor_replicates "
            "/inputs/max_failed_share /inputs/histogram_edges_m /inputs/quantity ");
  EXPECT_EQ(study_faults(R"({"case": {}, "realizations": 1e300})"), "/inputs/realizations ");
  EXPECT_EQ(study_faults(R"({"case": {}, "quantity": "x"})"), "/inputs/quantity ");
  EXPECT_EQ(study_faults(R"({"case": {"study": 3}})"), "/inputs/case/study ");
}

TEST(StudyInputs, NoFileAndNoLink) {
  EXPECT_EQ(study_faults(
                R"({"case": {"terrain": {"bed_csv": "/etc/passwd"}, "slide": {"outlines": [{"outline_csv": "a"}]}}})"),
            "/inputs/case/terrain/bed_csv /inputs/case/slide/outlines/0/outline_csv ");
  EXPECT_EQ(study_faults(R"({"case": {"href": "http://169.254.169.254/"}})"), "/inputs/case/href /inputs/case ");
}

TEST(StudyInputs, MessagesNameWhatStandsForTheFile) {
  const Json request = Json::parse(R"({"case": {"terrain": {"bed_csv": "a"}, "random_field": {"data_csv": "b"}}})");
  std::vector<std::string> messages;
  try {
    read_study_inputs(request);
  } catch (const Refusal& e) {
    for (const Fault& fault : e.faults) messages.push_back(fault.message);
  }
  ASSERT_EQ(messages.size(), 2u);
  EXPECT_NE(messages[0].find("the vertices themselves, as bed_m"), std::string::npos) << messages[0];
  EXPECT_NE(messages[1].find("the data themselves, as data: [[x, y, value, error], ...]"), std::string::npos)
      << messages[1];
}

TEST(EchoInputs, EveryTypeIsChecked) {
  EXPECT_EQ(echo_faults(R"({"s": "a", "pause": 0.5, "a": [1, 2], "b": {"bbox": [1, 2, 3, 4]}, "o": {"value": {"k": 1}},
                            "m": {"value": "<a/>", "mediaType": "text/xml"}, "x": true})"),
            "");
  EXPECT_EQ(echo_faults(R"({})"), "/inputs/s ");
  EXPECT_EQ(echo_faults(R"({"s": 1, "pause": -1, "a": [1.5], "b": {"bbox": [1]}, "o": [], "m": 1, "x": [], "y": 1})"),
            "/inputs/s /inputs/pause /inputs/a /inputs/b /inputs/o /inputs/m /inputs/x /inputs/y ");
}

TEST(EchoInputs, AnObjectMayLookLikeAQualifiedValue) {
  EXPECT_EQ(read_echo_inputs(Json::parse(R"({"s": "a", "o": {"value": "b"}})"))["o"], Json::parse(R"({"value": "b"})"));
  EXPECT_EQ(read_echo_inputs(Json::parse(R"({"s": "a", "o": {"value": {"k": 1}}})"))["o"], Json::parse(R"({"k": 1})"));
  EXPECT_EQ(echo_faults(R"({"s": "a", "o": {"href": "http://169.254.169.254/"}})"), "/inputs/o/href ");
}

TEST(EchoResults, OnlyWhatWasGivenAndWanted) {
  const Json inputs = Json::parse(R"({"s": "a", "pause": 1})");
  EXPECT_EQ(echo_results(inputs, {"s", "x"}), Json::parse(R"({"s": "a"})"));
  EXPECT_EQ(echo_results(inputs, {"x"}), Json::object());
}

TEST(Outputs, AreSelected) {
  Faults faults;
  EXPECT_EQ(read_outputs(Json::parse(R"({"outputs": {"b": {}}})"), {"a", "b"}, faults),
            (std::vector<std::string>{"b"}));
  EXPECT_EQ(read_outputs(Json::parse("{}"), {"a", "b"}, faults).size(), 2u);
  EXPECT_TRUE(faults.empty());
  read_outputs(Json::parse(R"({"outputs": {"c": {}, "a": {"transmissionMode": "reference"}, "b": 1}})"), {"a", "b"},
               faults);
  EXPECT_EQ(pointers([&] { refuse_if_any(faults, reason::bad_request, ""); }),
            "/outputs/c /outputs/a/transmissionMode /outputs/b ");
}

}  // namespace
}  // namespace talus::service
