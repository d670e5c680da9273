#include "phantoms/PhantomScene.h"

#include "files/appearance/PropertyWriter.h"
#include "io/EmbeddedResources.h"
#include "io/ProvenanceTag.h"

#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include <cstdlib>
#include <map>
#include <new>

namespace fenestra::core {

namespace {

/// Makes pugixml throw std::bad_alloc. By default it drops attributes when memory runs out, and
/// reports this only by result codes.
void throwIfOutOfMemory() {
  const auto allocate = [](std::size_t size) {
    void* const memory = std::malloc(size);
    return memory ? memory : throw std::bad_alloc();
  };
  pugi::set_memory_management_functions(allocate, std::free);
}

/// Encodes a file name or segment id as Slicer does in attributes: all characters except letters,
/// digits and "-_./" become %XX.
std::string urlEncode(const std::string& text) {
  TextWriter encoded;
  encoded << std::hex << std::uppercase;
  for (const char c : text) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (plain || std::string("-_./").find(c) != std::string::npos)
      encoded << c;
    else
      encoded << '%' << (static_cast<unsigned char>(c) >> 4)
              << (static_cast<unsigned char>(c) & 15);
  }
  return encoded.str();
}

/// Values for the placeholders in Resources/phantoms/scene.mrml.
using ScenePlaceholders = std::map<std::string, std::string>;

/// Adds the pose of a parallel camera that frames the volume's box in a square, with a margin of
/// 5 %.
void addCamera(ScenePlaceholders& texts, const Phantom& phantom) {
  const Grid& grid = phantom.volume.grid;
  const Vec3 center = grid.worldCenter();
  const Vec3 backward = phantom.towardViewer.normalized();
  const Vec3 right = Vec3::UnitZ().cross(backward).normalized();
  const Vec3 up = backward.cross(right);
  double scale = 0.0; // half the viewport's height, mm
  for (int i = 0; i < 8; ++i) {
    const Vec3 offset = grid.worldCorner(i) - center;
    scale = std::max({scale, 1.05 * std::abs(offset.dot(up)), 1.05 * std::abs(offset.dot(right))});
  }
  const double distance = 4.0 * grid.boundingRadius();
  const auto rounded = [&](const Vec3& v) { // 0 instead of rounding errors such as 1e-17
    return Vec3(v.unaryExpr([&](double x) { return std::abs(x) < 1e-9 * distance ? 0.0 : x; }));
  };
  texts["@position@"] = joinSpaced(rounded(center + distance * backward));
  texts["@center@"] = joinSpaced(rounded(center));
  texts["@up@"] = joinSpaced(up);
  texts["@scale@"] = joinSpaced(scale);
}

void addGeometry(ScenePlaceholders& texts, const Grid& grid) {
  const Mat3 directions = grid.indexToWorld.linear().normalizedColumns() + Mat3::Zero(); // no "-0"
  texts["@spacing@"] = joinSpaced(grid.spacing());
  texts["@origin@"] = joinSpaced(Vec3(grid.indexToWorld.translation()));
  texts["@directions@"] = joinSpaced(directions.row(0), directions.row(1), directions.row(2)) + " ";
  const Vec3 center = grid.worldCenter();
  texts["@handles@"] = "1 0 0 " + joinSpaced(center.x()) + "  0 1 0 " + joinSpaced(center.y()) +
                       "  0 0 1 " + joinSpaced(center.z()) + "  0 0 0 1";
}

void addAppearance(ScenePlaceholders& texts, const Phantom& phantom) {
  const Volume& volume = phantom.volume;
  texts["@window@"] = joinSpaced(volume.maximum - volume.minimum);
  texts["@level@"] = joinSpaced(0.5 * (volume.maximum + volume.minimum));
  std::string& displays = texts["@segment displays@"];
  for (const PhantomSegment& segment : phantom.segments)
    displays += urlEncode(segment.id) +
                " OverrideColorR:-1 OverrideColorG:-1 OverrideColorB:-1 Visible:true "
                "Visible3D:true Visible2DFill:true Visible2DOutline:true Opacity3D:1 "
                "Opacity2DFill:1 Opacity2DOutline:1|";
  const VolumeProperty& property = phantom.property;
  const PropertyStrings functions = encodePropertyStrings(property);
  texts["@shade@"] = property.shade ? "1" : "0";
  texts["@diffuse@"] = joinSpaced(property.diffuse);
  texts["@ambient@"] = joinSpaced(ambientLight);
  texts["@specular@"] = joinSpaced(property.specular);
  texts["@specular power@"] = joinSpaced(property.specularPower);
  texts["@scalar opacity@"] = functions.scalarOpacity;
  texts["@gradient opacity@"] = functions.gradientOpacity;
  texts["@color@"] = functions.color;
  texts["@range@"] = joinSpaced(volume.minimum, volume.maximum);
}

} // namespace

std::string makePhantomScene(const Phantom& phantom, const std::string& name,
                             const std::string& data) {
  const std::string files = urlEncode(data + name);
  ScenePlaceholders texts = {{"@volume@", name},
                             {"@segmentation@", name + " segments"},
                             {"@property@", name + " property"},
                             {"@volume file@", files + ".nrrd"},
                             {"@segmentation file@", files + ".seg.nrrd"},
                             {"@property file@", files + ".vp"},
                             {"@roi file@", files + "-roi.mrk.json"}};
  addCamera(texts, phantom);
  addGeometry(texts, phantom.volume.grid);
  addAppearance(texts, phantom);

  throwIfOutOfMemory();
  pugi::xml_document document;
  const std::string_view scene = findResource("phantoms/scene.mrml");
  document.load_buffer(scene.data(), scene.size(), pugi::parse_default | pugi::parse_declaration);
  for (const pugi::xml_node node : document.child("MRML"))
    for (pugi::xml_attribute attribute : node.attributes())
      if (*attribute.value() == '@')
        attribute = texts.at(attribute.value()).c_str();
  document.append_child(pugi::node_comment)
      .set_value((" " + std::string(blankProvenanceTag) + " ").c_str());
  TextWriter stream;
  document.save(stream, " ");
  return sealProvenanceTag(stream.str());
}

std::string makePhantomRoi(const Phantom& phantom) {
  using Json = nlohmann::ordered_json;
  const Grid& grid = phantom.volume.grid;
  const Mat3 axes =
      (lpsToRas * grid.indexToWorld.linear()).normalizedColumns() + Mat3::Zero(); // no "-0"
  const Vec3 center = (lpsToRas * grid.worldCenter()).array() + 0.0;
  Json file = Json::parse(findResource("phantoms/roi.mrk.json"));
  file["generator"] = blankProvenanceTag;
  Json& roi = file["markups"][0];
  Json& point = roi["controlPoints"][0];
  roi["center"] = point["position"] = center;
  roi["size"] = Vec3(grid.spacing().cwiseProduct(grid.size.cast<double>()));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      roi["orientation"].push_back(axes(row, column));
  point["orientation"] = roi["orientation"];
  return sealProvenanceTag(file.dump(4) + "\n");
}

} // namespace fenestra::core
