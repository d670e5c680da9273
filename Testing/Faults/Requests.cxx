#include "Requests.h"

#include <fstream>
#include <stdexcept>

#include <unistd.h>

namespace fenestra::faults {
namespace {

namespace fs = std::filesystem;

using Arguments = std::vector<std::string>;

Arguments joined(Arguments words, const Arguments& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

std::vector<Request> makeRequests() {
  const Arguments quick = {"--size",    "16x16", "--samples",  "1",
                           "--threads", "1",     "--progress", "none"};
  const Arguments render =
      joined({"render", "knee.mrb", "--focus", "FemoralCartilage", "--output", "o.exr", "--output",
              "o.png", "--surface", "o.vtp", "--stats", "s.json"},
             quick);
  const Arguments turntable = joined({"turntable", "knee.mrb", "--frames", "2", "--output", "t.png",
                                      "--stats", "s.json", "--restart"},
                                     quick);
  const Arguments study = joined({"study", "t.csv", "--output", "d"}, quick);
  const Arguments phantom = {"phantom", "cube", "--output", "p", "--size", "16"};
  const auto kept = [](const char* samples) {
    return Arguments{"render",       "knee.mrb",  "--size",   "16x16",      "--samples",
                     samples,        "--threads", "1",        "--progress", "none",
                     "--checkpoint", "o.film",    "--output", "o.exr"};
  };
  const auto part = [](const char* shard, const char* film) {
    return Arguments{"render", "knee.mrb", "--shard", shard, "--checkpoint", film};
  };
  Request three = {"phantom", phantom, {joined(phantom, {"--edge", "2"})}, {{}}, "", ""};
  for (const char* ending :
       {".mrml", ".mrb", ".nrrd", ".seg.nrrd", ".vp", ".vp.json", "-roi.mrk.json"})
    three.groups[0].push_back("p/cube" + std::string(ending));
  return {
      {"render",
       render,
       {joined(render, {"--seed", "7", "--offset", "2"})},
       {{"o.exr", "o.png", "o.vtp"}},
       "s.json",
       ""},
      {"turntable",
       turntable,
       {joined(turntable, {"--seed", "7"})},
       {{"t_0000.png"}, {"t_0001.png"}},
       "s.json",
       "t.turntable.json"},
      three,
      {"study",
       study,
       {joined(study, {"--seed", "7"})},
       {{"d/a/a.png"}},
       "d/a/a.json",
       "d/a/a.study.json",
       "",
       "d/a/a.film",
       {{"t.csv", "name,input\na,knee.mrb\n"}}},
      {"checkpoint", kept("2"), {kept("1")}, {{"o.exr"}}, "", "", "o.film"},
      {"merge",
       {"merge", "a.film", "b.film", "--output", "o.exr", "--threads", "1", "--progress", "none"},
       {joined(part("1/2", "a.film"), quick), joined(part("2/2", "b.film"), quick),
        joined({"render", "knee.mrb", "--seed", "7", "--output", "o.exr"}, quick)},
       {{"o.exr"}},
       "",
       ""},
  };
}

} // namespace

const std::vector<Request>& requests() {
  static const std::vector<Request> made = makeRequests();
  return made;
}

std::string bytesOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Files Place::filesIn(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_directory())
      files[name + "/"];
    else
      files[name] = bytesOf(entry.path());
  }
  return files;
}

Place::Place(const Tools& tools) : m_tools(tools) {
  const fs::path memory = "/dev/shm";
  std::string name =
      ((::access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path()) / "faults-XXXXXX")
          .string();
  if (!::mkdtemp(name.data()))
    throw std::runtime_error("no folder for runs");
  m_root = name;
}

Place::~Place() {
  std::error_code ignored;
  fs::remove_all(m_root, ignored);
}

void Place::fill(const Files& files) const {
  for (const fs::path& made : {folder(), temporary()}) {
    fs::remove_all(made);
    fs::create_directory(made);
  }
  for (const auto& [name, content] : files)
    if (name.ends_with('/'))
      fs::create_directories(folder() / name);
    else
      std::ofstream(folder() / name, std::ios::binary) << content;
}

Outcome Place::run(const Arguments& words, const Fault& fault) const {
  return faults::run(
      {joined({m_tools.executable.string()}, words), folder(), temporary(), m_tools.preload},
      fault);
}

Subject learn(const Request& request, const Tools& tools) {
  const Place place(tools);
  Files inputs = request.inputs;
  inputs.emplace("knee.mrb", bytesOf(tools.data / "knee/knee.mrb"));
  Subject subject = {&request, {}, {}, {"a.film", "b.film"}, {}};
  for (const auto& [name, content] : inputs)
    subject.inputs.push_back(name);
  place.fill(inputs);
  std::vector<Outcome> outcomes;
  for (const Arguments& words : request.before)
    outcomes.push_back(place.run(words, {}));
  subject.before = place.files();
  subject.undisturbed = place.run(request.words, {Fault::Kind::counting});
  subject.after = place.files();
  outcomes.push_back(subject.undisturbed);
  for (const Outcome& outcome : outcomes)
    if (outcome.status != 0)
      throw std::runtime_error(request.name + " fails without a fault: " + outcome.errors);
  if (subject.undisturbed.calls == 0 || subject.undisturbed.allocations == 0)
    throw std::runtime_error("where main begins is not seen");
  return subject;
}

} // namespace fenestra::faults
