// The executable as a command line module of Slicer: its XML description follows the rules of
// Slicer's execution model, whose parser rejects a module at its first error, and it runs with the
// arguments that Slicer passes.

#include "CommandTesting.h"

#include <pugixml.hpp>

#include <cstring>
#include <map>
#include <regex>

namespace fenestra::core::SlicerCommandTests {
namespace {

using Names = std::set<std::string>;

const Names numberTypes = {"integer", "double"};
const Names simpleTypes = {"integer", "double", "string", "boolean", "string-enumeration"};
const Names vectorTypes = {"string-vector", "double-vector"};

/// Allowed attributes per parameter type.
const std::map<std::string, Names> allowedAttributes = {
    {"integer", {}},
    {"double", {}},
    {"string", {}},
    {"string-enumeration", {}},
    {"string-vector", {}},
    {"double-vector", {}},
    {"file", {"fileExtensions", "multiple"}},
    {"image", {"type", "fileExtensions", "multiple", "reference", "hidden"}},
};

/// Options that got another name than that of version 0.1, by the latter.
const std::map<std::string, std::string> renamed = {
    {"boundary", "clip-boundary"}, {"density", "density-scale"},      {"offset", "clip-offset"},
    {"shift", "transfer-shift"},   {"smoothing", "spline-smoothing"}, {"soft", "clip-softness"},
    {"stats", "stats-json"}};

Names childNames(const pugi::xml_node& node) {
  Names names;
  for (const pugi::xml_node& child : node.children())
    names.insert(child.name());
  return names;
}

bool isNumber(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == 0;
}

void checkConstraints(const pugi::xml_node& parameter, const std::string& name) {
  const pugi::xml_node constraints = parameter.child("constraints");
  if (!constraints)
    return;
  EXPECT_TRUE(numberTypes.contains(parameter.name())) << name;
  EXPECT_EQ(childNames(constraints), (Names{"minimum", "maximum", "step"})) << name;
  const double start = parameter.child("default").text().as_double();
  EXPECT_LE(constraints.child("minimum").text().as_double(), start) << name;
  EXPECT_GE(constraints.child("maximum").text().as_double(), start) << name;
  EXPECT_GT(constraints.child("step").text().as_double(), 0.0) << name;
}

/// Slicer always passes the values of number and choice fields, so each needs a default.
void checkDefault(const pugi::xml_node& parameter, const std::string& name, bool isReturned) {
  const std::string type = parameter.name();
  const std::string start = parameter.child_value("default");
  EXPECT_TRUE(!numberTypes.contains(type) || isReturned || isNumber(start))
      << name << ": '" << start << "'";
  if (type != "string-enumeration") {
    EXPECT_FALSE(parameter.child("element")) << name;
    return;
  }
  Names words;
  for (const pugi::xml_node& element : parameter.children("element"))
    EXPECT_TRUE(words.insert(element.text().get()).second) << name;
  EXPECT_TRUE(words.contains(start)) << name << ": '" << start << "'";
}

void checkParameter(const pugi::xml_node& parameter, Names& known) {
  static const std::regex identifier("[A-Za-z_][A-Za-z0-9_]*");
  const std::string type = parameter.name();
  const std::string name = parameter.child_value("name");
  ASSERT_TRUE(allowedAttributes.contains(type)) << type << " " << name;
  for (const pugi::xml_attribute& attribute : parameter.attributes())
    EXPECT_TRUE(allowedAttributes.at(type).contains(attribute.name())) << name;
  Names tags;
  for (const pugi::xml_node& child : parameter.children()) {
    EXPECT_TRUE((Names{"name", "longflag", "label", "description", "default", "channel", "index",
                       "constraints", "element"})
                    .contains(child.name()))
        << name << " " << child.name();
    EXPECT_TRUE(tags.insert(child.name()).second || child.name() == std::string("element")) << name;
  }
  EXPECT_TRUE(std::regex_match(name, identifier)) << name;
  EXPECT_TRUE(known.insert(name).second) << name << " occurs twice";
  EXPECT_NE(std::string(parameter.child_value("label")), "") << name;
  EXPECT_NE(std::string(parameter.child_value("description")), "") << name;
  const std::string channel = parameter.child_value("channel");
  const bool hasOption = !!parameter.child("longflag");
  const bool isPositional = !!parameter.child("index");
  const bool isReturned = !hasOption && !isPositional;
  EXPECT_TRUE(!hasOption || std::regex_match(parameter.child_value("longflag"), identifier))
      << name;
  EXPECT_FALSE(hasOption && isPositional) << name;
  if (isReturned) {
    EXPECT_TRUE(simpleTypes.contains(type)) << name;
    EXPECT_EQ(channel, "output") << name;
  }
  const bool isFile = type == "image" || type == "file";
  EXPECT_TRUE(!isFile || channel == "input" || channel == "output") << name;
  checkConstraints(parameter, name);
  checkDefault(parameter, name, isReturned);
}

class SlicerCommand : public SmallScene {
protected:
  pugi::xml_document description() const {
    const Outcome outcome = run({"--xml"}, folder.path());
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    pugi::xml_document document;
    const auto result = document.load_string(outcome.out.c_str());
    EXPECT_TRUE(result) << result.description();
    return document;
  }

  /// Canonical names of the options in the help, by their one-word names.
  std::map<std::string, std::string> readNames() const {
    const std::string help = run({"--help", "all"}, folder.path()).out;
    std::map<std::string, std::string> names;
    static const std::regex option("\n  (?:-[a-z], |    )--([a-z-]+)");
    for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
      std::string name = (*it)[1], oneWord = name;
      std::erase(oneWord, '-');
      for (const auto& [former, now] : renamed)
        oneWord = now == name ? former : oneWord;
      names[oneWord] = name;
    }
    return names;
  }

  /// The options that Slicer passes if no value in its panel was changed.
  static Arguments makeDefaultArguments(const pugi::xml_document& document) {
    Arguments options;
    for (const pugi::xml_node& group : document.child("executable").children("parameters"))
      for (const pugi::xml_node& parameter : group.children()) {
        const std::string start = parameter.child_value("default");
        if (!parameter.child("longflag") || start.empty())
          continue;
        options.push_back(std::string("--") + parameter.child_value("longflag"));
        options.push_back(start);
      }
    return options;
  }
};

TEST_F(SlicerCommand, XmlHasOnlyElementsThatSlicerAllows) {
  const pugi::xml_document document = description();
  const pugi::xml_node module = document.child("executable");
  ASSERT_TRUE(module);
  const Names before = {"category",          "title",   "description", "version",
                        "documentation-url", "license", "contributor", "acknowledgements"};
  Names known;
  bool parameters = false;
  for (const pugi::xml_node& child : module.children()) {
    const std::string name = child.name();
    if (name != "parameters") {
      EXPECT_TRUE(before.contains(name) && !parameters) << name;
      continue;
    }
    parameters = true;
    auto part = child.begin();
    EXPECT_EQ(std::string((part++)->name()), "label");
    EXPECT_EQ(std::string((part++)->name()), "description");
    for (; part != child.end(); ++part)
      checkParameter(*part, known);
  }
  EXPECT_GT(known.size(), 30u);
}

TEST_F(SlicerCommand, XmlDescribesEveryOptionOfTheHelp) {
  Names described = {"help", "version", "quiet", "verbose", "paper", "strict"};
  const pugi::xml_document document = description();
  for (const pugi::xpath_node& option : document.select_nodes("//longflag"))
    described.insert(option.node().text().get());
  Names listed;
  for (const auto& [oneWord, name] : readNames())
    listed.insert(oneWord);
  EXPECT_EQ(described, listed);
}

TEST_F(SlicerCommand, ReadmeTableEqualsTheXml) {
  std::string table = "| option | what it does | default in Slicer's panel |\n|---|---|---|\n";
  const pugi::xml_document document = description();
  const auto names = readNames();
  for (const pugi::xpath_node& option : document.select_nodes("//parameters/*[longflag]")) {
    const pugi::xml_node parameter = option.node();
    const std::string start = parameter.child_value("default");
    const std::string oneWord = parameter.child_value("longflag"), &name = names.at(oneWord);
    table += "| `--" + name + "`" + (renamed.contains(oneWord) ? " (`" + oneWord + "`)" : "") +
             " | " + parameter.child_value("description") + " | " +
             (start.empty() ? "" : "`" + start + "`") + " |\n";
  }
  const std::string readme = readBytes(FENESTRA_README);
  const std::size_t begin = readme.find("<!-- options: ");
  const std::size_t end = readme.find("<!-- end of options -->");
  ASSERT_TRUE(begin < end && end != std::string::npos);
  const std::size_t after = readme.find('\n', begin) + 1;
  EXPECT_EQ(readme.substr(after, end - after), table) << "Renderer/program/README.md should have:\n"
                                                      << table;
}

TEST_F(SlicerCommand, FileBesideTheExecutableEqualsTheXml) {
  const std::filesystem::path sibling =
      std::filesystem::path(FENESTRA_EXECUTABLE).replace_extension(".xml");
  EXPECT_EQ(readBytes(sibling), run({"--xml"}, folder.path()).out);
}

TEST_F(SlicerCommand, DefaultPanelArgumentsRender) {
  // Only size and samples are reduced: the default values of the other options must not conflict.
  Arguments arguments = makeDefaultArguments(description());
  const auto size = std::find(arguments.begin(), arguments.end(), "--size");
  ASSERT_NE(size, arguments.end());
  *(size + 1) = "16x16";
  for (const Arguments& more :
       {Arguments{"--samples", "2"},
        {"--samples", "2", "--segmentation", "segments.seg.nrrd", "--focus", "A"}}) {
    Arguments all = {"--processinformationaddress", "0", "--returnparameterfile", "values.params"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), more.begin(), more.end());
    all.insert(all.end(), {"--output", "image.nrrd", "volume.nrrd"});
    const Outcome outcome = run(all, folder.path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(outcome.out.starts_with("<filter-start>")) << outcome.out;
    EXPECT_NE(outcome.out.find("<filter-progress>1"), std::string::npos) << outcome.out;
    EXPECT_TRUE(std::filesystem::exists(folder / "image.nrrd"));
    EXPECT_FALSE(std::filesystem::exists(folder / "image-Z.nrrd")); // Slicer does not expect it
    const std::string values = readBytes(folder / "values.params");
    EXPECT_TRUE(values.starts_with("samplesPerPixel = 2\n")) << values;
    EXPECT_NE(values.find("\nrenderSeconds = "), std::string::npos) << values;
  }
}

TEST_F(SlicerCommand, WarningsForSlicerGoToStandardOutput) {
  std::string samples(64 * sizeof(float), '\0');
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(samples.data(), &nan, sizeof nan);
  NrrdText text;
  text.type = "float";
  folder.write("holes.nrrd", text.encode(samples));
  const Arguments plain = {"holes.nrrd", "--size", "8x8", "--samples", "1"};
  EXPECT_NE(run(plain, folder.path()).err.find("warning: "), std::string::npos);
  Arguments slicers = plain;
  slicers.insert(slicers.end(), {"--returnparameterfile", "values.params"});
  const Outcome outcome = run(slicers, folder.path());
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("warning: "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("\nholes.png: 8x8 pixels, "), std::string::npos) << outcome.out;
}

TEST_F(SlicerCommand, EchoPrintsTheParsedValues) {
  const Outcome outcome = renderVolume({"--echo", "--seed", "7", "--output", "a.png"});
  EXPECT_EQ(outcome.status, 0);
  for (const char* line : {"INPUT: volume.nrrd\n", "seed: 7\n", "output: a.png\n", "echo: yes\n"})
    EXPECT_NE(outcome.out.find(line), std::string::npos) << line << outcome.out;
}

} // namespace
} // namespace fenestra::core::SlicerCommandTests
