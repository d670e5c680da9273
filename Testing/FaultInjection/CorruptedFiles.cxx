// Renders and inspects corrupted files of every format. usage: CorruptedFiles FENESTRA FIRST LAST
// The number of a run determines its file and corruption. Prints CSV, and violations to standard
// error; exit status 1 if a run crashes, hangs, uses more than 2 GB, prints more than one line or
// leaves a file. A single run (FIRST = LAST) saves its files to corrupted-FIRST/.
#include "Corruption.h"
#include "Invariants.h"

#include "files/formats/ZipWriter.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace fenestra::core::faults {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;

/// File to corrupt, with other files that the command reads, and the command.
struct Target {
  std::string name;
  Files files;
  bool isPacked = false; ///< packed into a.mrb with the other files
  Arguments arguments;   ///< arguments of a render or a comparison
};

/// Files in Testing/Data; its folder traps/ has the format variants (writeFormatVariants).
class Samples {
public:
  explicit Samples(const fs::path& data) : m_data(data) {}

  std::string read(const std::string& name) const {
    const std::string bytes = readBytes(m_data / name);
    if (bytes.empty())
      throw std::runtime_error(name + " does not exist");
    return bytes;
  }
  /// Seed of a fuzz target, without its first byte, which selects the format.
  std::string readSeed(const std::string& name) const {
    return read("../Fuzz/Corpus/" + name).substr(1);
  }

private:
  fs::path m_data;
};

/// Adds traps/scene.mrml and the files that it references; each is corrupted in turn.
void addScene(std::vector<Target>& targets, const Samples& samples) {
  Files files;
  for (const char* name :
       {"scene.mrml", "plain.nrrd", "layers.seg.nrrd", "property.vp", "roi.mrk.json"})
    files[name] = samples.read("traps/" + std::string(name));
  for (const auto& [name, content] : files) {
    targets.push_back({name, files, false, {"render", "scene.mrml", "--focus", "Heart"}});
    targets.push_back({name, files, true, {"render", "a.mrb", "--focus", "Heart"}});
  }
}

/// Adds scenes that transform the volume by a transform file.
void addTransforms(std::vector<Target>& targets, const Samples& samples) {
  for (const char* name : {"affine.h5", "affine.mat", "affine.tfm", "composite.tfm"}) {
    const std::string scene =
        "<MRML version=\"Slicer 5.6.2 32448\"><TransformStorage id=\"ts\" fileName=\"" +
        std::string(name) +
        "\"/><Transform id=\"t\" references=\"storage:ts;\"/><VolumeArchetypeStorage id=\"s\" "
        "fileName=\"plain.nrrd\"/><Volume id=\"v\" references=\"storage:s;transform:t;\"/></MRML>";
    targets.push_back({name,
                       {{name, samples.read("../Fuzz/Sandbox/Transform/" + std::string(name))},
                        {"s.mrml", scene},
                        {"plain.nrrd", samples.read("traps/plain.nrrd")}},
                       false,
                       {"render", "s.mrml"}});
  }
}

void addVolumes(std::vector<Target>& targets, const Samples& samples) {
  for (const char* name : {"volume.nii", "volume.mha", "gzip.nrrd", "ascii.nrrd", "double.nrrd"})
    targets.push_back(
        {name, {{name, samples.readSeed("Volume/" + std::string(name))}}, false, {"render", name}});
  targets.push_back({"detached.nhdr",
                     {{"detached.nhdr", samples.read("traps/detached.nhdr")},
                      {"detached.raw", samples.read("traps/detached.raw")}},
                     false,
                     {"render", "detached.nhdr"}});
  for (const char* name : {"native.dcm", "jpeg2000.dcm"})
    targets.push_back(
        {"d/" + std::string(name),
         {{"d/", ""},
          {"d/" + std::string(name), samples.read("../Fuzz/Sandbox/Dicom/" + std::string(name))}},
         false,
         {"render", "d"}});
}

/// Adds files that options name: transfer functions, lights, presets, segmentations and maps.
void addOptionFiles(std::vector<Target>& targets, const Samples& samples) {
  const Files volume = {{"plain.nrrd", samples.read("traps/plain.nrrd")}};
  const auto add = [&](const std::string& name, const std::string& content, Arguments arguments,
                       const Files& more = {}) {
    Target target = {name, volume, false, {"render", "plain.nrrd"}};
    target.files[name] = content;
    target.files.insert(more.begin(), more.end());
    target.arguments.insert(target.arguments.end(), arguments.begin(), arguments.end());
    targets.push_back(target);
  };
  for (const char* name : {"midpoint.vp.json", "property.vp", "thin.json", "hybrid.json"})
    add(name, samples.read("traps/" + std::string(name)), {"--transfer", name});
  add("lights.json", samples.read("traps/lights.json"), {"--lights", "lights.json"});
  add("preset.json", samples.read("../Fuzz/Corpus/Preset/all.json"), {"--preset", "preset.json"});
  add("labels.nrrd", samples.read("traps/labels.nrrd"),
      {"--segmentation", "labels.nrrd", "--focus", "1"});
  add("cropped.seg.nrrd", samples.read("traps/cropped.seg.nrrd"),
      {"--segmentation", "cropped.seg.nrrd", "--focus", "1"});
  const std::string list = samples.readSeed("Surface/box.vtm"),
                    surface = samples.readSeed("Surface/box.vtp");
  const Arguments segments = {"--segmentation", "b.vtm", "--focus", "1"};
  add("b.vtm", list, segments, {{"s.vtp", surface}});
  add("s.vtp", surface, segments, {{"b.vtm", list}});
  for (const char* name : {"picture.exr", "picture.nrrd", "picture.png", "picture.tif"})
    targets.push_back({name,
                       {{name, samples.readSeed("Image/" + std::string(name))}},
                       false,
                       {"compare", name, name, "--output", "o.png"}});
  add("sky.exr", samples.readSeed("Image/picture.exr"), {"--environment", "sky.exr"});
}

std::vector<Target> makeTargets(const Samples& samples) {
  std::vector<Target> targets;
  addScene(targets, samples);
  addTransforms(targets, samples);
  addVolumes(targets, samples);
  addOptionFiles(targets, samples);
  return targets;
}

/// Writes the files of run `number` to the workspace; returns the command.
Arguments prepare(const Target& target, long number, const Workspace& workspace) {
  std::mt19937_64 random(static_cast<std::uint64_t>(number));
  Files files = target.files;
  files[target.name] = corrupt(files[target.name], random);
  Arguments arguments = target.arguments;
  if (arguments[0] == "render" && random() % 4 == 0)
    arguments = {"inspect", arguments[1], "--json"};
  else if (arguments[0] == "render")
    for (const char* word : {"--size", "8x8", "--samples", "1", "--bounces", "8", "--threads", "1",
                             "--quiet", "--output", "o.png"})
      arguments.emplace_back(word);
  if (!target.isPacked) {
    workspace.fill(files);
    return arguments;
  }
  std::vector<ZipEntry> entries;
  for (const auto& [name, content] : files)
    entries.push_back({"a/" + name, content});
  workspace.fill({{"a.mrb", encodeZip(entries, "", "a.mrb")}});
  return arguments;
}

/// Violation of a run; empty if the file was accepted or correctly rejected.
std::string findViolation(const Outcome& outcome, const Files& before, const Workspace& workspace) {
  constexpr long maxMemory = 2'000'000; // kB
  if (outcome.hasTimedOut)
    return "hangs";
  if (outcome.signal != 0)
    return "crashes with signal " + std::to_string(outcome.signal) + " in " +
           findCulprit(outcome.frames).function;
  if (outcome.status != 0 && outcome.status != 2 && outcome.status != 3 && outcome.status != 4)
    return "ends with status " + std::to_string(outcome.status);
  if (outcome.peakKilobytes > maxMemory)
    return "uses more than 2 GB";
  const std::size_t lines = listErrorLines(outcome).size();
  if (lines != (outcome.status == 0 ? 0U : 1U))
    return std::to_string(lines) + " error lines and status " + std::to_string(outcome.status);
  Files after = workspace.files();
  after.erase("o.png");
  if (after != before || !workspace.tempFiles().empty())
    return "creates or changes a file";
  return "";
}

struct Result {
  int status = -1;
  std::string violation;
};

Result runOne(const std::vector<Target>& targets, long number, const Workspace& workspace) {
  const Target& target = targets[static_cast<std::size_t>(number) % targets.size()];
  const Arguments arguments = prepare(target, number, workspace);
  const Files before = workspace.files();
  const Outcome outcome = workspace.run(arguments, {}); // without a fault
  return {outcome.status, findViolation(outcome, before, workspace)};
}

std::vector<Result> runAll(const std::vector<Target>& targets, long first, long last,
                           const Tools& tools) {
  std::vector<Result> results(static_cast<std::size_t>(last - first + 1));
  std::atomic<long> next = first;
  std::vector<std::thread> workers;
  for (unsigned i = 0; i < std::max(1U, std::thread::hardware_concurrency()); ++i)
    workers.emplace_back([&] {
      const Workspace workspace(tools);
      for (long number; (number = next++) <= last;) {
        Result& result = results[static_cast<std::size_t>(number - first)];
        result = runOne(targets, number, workspace);
        if (!result.violation.empty())
          std::fprintf(stderr, "%ld: %s\n", number, result.violation.c_str());
      }
    });
  for (std::thread& worker : workers)
    worker.join();
  return results;
}

/// Prints the results as CSV. True if there is no violation.
bool print(const std::vector<Target>& targets, const std::vector<Result>& results, long first) {
  struct Row {
    long runs = 0, accepted = 0, rejected = 0;
  };
  std::map<std::string, Row> rows;
  bool passed = true;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const long number = first + static_cast<long>(i);
    const Target& target = targets[static_cast<std::size_t>(number) % targets.size()];
    Row& row = rows[target.name + (target.isPacked ? " in a .mrb" : "")];
    ++row.runs;
    ++(results[i].status == 0 ? row.accepted : row.rejected);
    passed = passed && results[i].violation.empty();
  }
  std::puts("file,runs,accepted,rejected");
  for (const auto& [name, row] : rows)
    std::printf("%s,%ld,%ld,%ld\n", name.c_str(), row.runs, row.accepted, row.rejected);
  return passed;
}

/// Saves the files of a run and prints the command, to reproduce a violation manually.
void saveInputs(const std::vector<Target>& targets, long number, const Tools& tools) {
  const Workspace workspace(tools);
  const Target& target = targets[static_cast<std::size_t>(number) % targets.size()];
  const fs::path folder = "corrupted-" + std::to_string(number);
  std::string command = "cd " + folder.string() + " && fenestra";
  for (const std::string& word : prepare(target, number, workspace))
    command += " " + word;
  fs::copy(workspace.folder(), folder,
           fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  std::printf("%s\n", command.c_str());
}

int runCorruptedFiles(int count, char** arguments) {
  if (count != 4) {
    std::fputs("usage: CorruptedFiles FENESTRA FIRST LAST\n", stderr);
    return 2;
  }
  const Tools tools = {fs::canonical(arguments[1]), FENESTRA_PRELOAD, FENESTRA_TEST_DATA};
  const std::vector<Target> targets = makeTargets(Samples(tools.data));
  const long first = std::atol(arguments[2]), last = std::atol(arguments[3]);
  if (first == last)
    saveInputs(targets, first, tools);
  return print(targets, runAll(targets, first, last, tools), first) ? 0 : 1;
}

} // namespace
} // namespace fenestra::core::faults

int main(int count, char** arguments) {
  try {
    return fenestra::core::faults::runCorruptedFiles(count, arguments);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "CorruptedFiles: %s\n", error.what());
    return 1;
  }
}
