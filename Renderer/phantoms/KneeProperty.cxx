#include "phantoms/Knee.h"

namespace fenestra {

VolumeProperty kneeProperty() {
  VolumeProperty property;
  // Air and flow voids are transparent. Cartilage is far denser than the values between its own and
  // those of fluid (215) or cortex (66): partial volume shows no muscle red on its border.
  property.scalarOpacity = {{0, 0},      {46, 0},     {70, 0.30},  {130, 0.42}, {185, 0.20},
                            {240, 0.14}, {300, 0.30}, {350, 0.42}, {400, 0.40}, {450, 0.75},
                            {500, 0.97}, {580, 0.97}, {650, 0.60}, {740, 0.45}, {1200, 0.50}};
  property.gradientOpacity = {{0, 1}, {2000, 1}};
  property.color = {{0, {0.90, 0.84, 0.76}},   {70, {0.93, 0.88, 0.80}},  {130, {0.95, 0.91, 0.85}},
                    {190, {0.92, 0.84, 0.78}}, {250, {0.86, 0.60, 0.53}}, {310, {0.80, 0.42, 0.35}},
                    {370, {0.82, 0.44, 0.37}}, {415, {0.91, 0.71, 0.61}}, {455, {0.93, 0.93, 0.95}},
                    {500, {0.94, 0.96, 0.98}}, {590, {0.94, 0.96, 0.97}}, {650, {0.97, 0.94, 0.82}},
                    {740, {0.97, 0.86, 0.65}}, {810, {0.97, 0.86, 0.62}}, {870, {0.98, 0.90, 0.68}},
                    {960, {0.99, 0.93, 0.76}}};
  property.unitDistance = 1.0;
  property.shade = true;
  property.diffuse = 0.9;
  property.specular = 0.25;
  property.specularPower = 20.0;
  return property;
}

} // namespace fenestra
