// Codes, advice and exit statuses of errors; the only test that compares wording.

#include "ErrorChecks.h"
#include "files/segments/LabelNames.h"
#include "io/InputRegistry.h"
#include "io/JsonNode.h"
#include "program/ErrorAdvice.h"
#include "program/Options.h"
#include "program/RenderOptions.h"
#include "program/UsageError.h"
#include "scene/Defaults.h"
#include "scene/NamedPresets.h"

#include <regex>
#include <set>

namespace fenestra::core::ErrorAdviceTests {
namespace {

std::vector<ErrorCode> listCodes() {
  std::vector<ErrorCode> codes;
  for (int code = 0; code <= static_cast<int>(ErrorCode::usage); ++code) // the last one
    codes.push_back(static_cast<ErrorCode>(code));
  return codes;
}

TEST(ErrorCodes, EachHasItsOwnWord) {
  std::set<std::string_view> words;
  for (const ErrorCode code : listCodes())
    EXPECT_TRUE(words.insert(toString(code)).second) << toString(code);
}

TEST(ErrorAdvice, NamesOnlyExistingOptions) {
  const std::regex option("--([a-z-]+)");
  int count = 0;
  for (const ErrorCode code : listCodes()) {
    const std::string advice(findAdvice(code));
    for (std::sregex_iterator it(advice.begin(), advice.end(), option), end; it != end; ++it) {
      EXPECT_TRUE(findOption(renderSyntax.options, it->str(1))) << advice;
      ++count;
    }
  }
  EXPECT_GT(count, 30);
}

TEST(ErrorAdvice, ExitStatusesFollowTheKind) {
  EXPECT_EQ(exitStatus(ErrorKind::request), 2);
  EXPECT_EQ(exitStatus(ErrorKind::input), 3);
  EXPECT_EQ(exitStatus(ErrorKind::output), 4);
}

/// Complete message of the Error that `action` throws.
template <typename Action>
std::string compose(Action&& action) {
  try {
    action();
  } catch (const Error& error) {
    return composeMessage(error.message());
  }
  return "no error";
}

TEST(ErrorAdvice, CompleteMessages) {
  EXPECT_EQ(compose([] { requireFile("none.nrrd", ""); }),
            "none.nrrd: no such file; check the name");
  EXPECT_EQ(compose([] { parseJson("{", "a.json"); }),
            "a.json: is not valid JSON at byte 2; check its brackets, commas and quotes");
  EXPECT_EQ(compose([] {
              const nlohmann::json document = {{"g", 3}};
              JsonNode(document, "a.json").at("g").number(-1.0, 1.0);
            }),
            "a.json: g: is 3; it must be from -1 to 1");
  EXPECT_EQ(compose([] { findLights("sun"); }), "sun: no such file or preset; expected a file or "
                                                "one of amber, cinema, headlight, soft, studio, "
                                                "theatre-wet, theatre");
  EXPECT_EQ(
      compose([] { readLabelNames("a.xlsx"); }),
      "a.xlsx: has no extension of a label table; give a .ctbl, .txt, .label, .json, .csv or .tsv");
  EXPECT_EQ(compose([] { adjustView({.scale = 1.0}, {.projection = Projection::perspective}); }),
            "scale: the scene's camera is perspective; use --angle, or add --projection "
            "orthographic");
  EXPECT_EQ(compose([] { throw usageError("--size: expected WIDTHxHEIGHT, got '", 7, "'"); }),
            "--size: expected WIDTHxHEIGHT, got '7'");
  EXPECT_EQ(composeMessage(makeMessage(ErrorCode::tinyFocus, "focus", "covers hardly a pixel")),
            "focus: covers hardly a pixel; use a larger --size, or a --view that frames the focus");
}

TEST(UsageError, SubjectEndsAtTheFirstColon) {
  const Message option = usageError("--", "view", ": auto: requires a focus").message();
  EXPECT_EQ(option, (Message{ErrorCode::usage, "--view", "auto: requires a focus"}));
  EXPECT_EQ(usageError("expected an object").message().subject, "");
}

} // namespace
} // namespace fenestra::core::ErrorAdviceTests
