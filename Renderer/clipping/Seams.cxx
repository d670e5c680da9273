#include "clipping/Seams.h"

#include "clipping/FocusCells.h"
#include "clipping/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

namespace fenestra {

namespace {

/// Of each cell between samples, told by its first one, whether the focus may end in it, hide a
/// part of itself or fall away steeply.
std::vector<std::uint8_t> uncertainCells(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<std::uint8_t> result(focus.regions.size(), 0);
  for (std::int64_t row = 0; row + 1 < buffer.rows(); ++row)
    for (std::int64_t column = 0; column + 1 < buffer.columns(); ++column) {
      double least = infinity, greatest = -infinity;
      for (const std::int64_t r : {row, row + 1})
        for (const std::int64_t c : {column, column + 1}) {
          const double depth = buffer.at(buffer.sample(c, r)); // infinite beside the focus
          least = std::min(least, depth);
          greatest = std::max(greatest, depth);
        }
      const DepthAxis& x = buffer.xAxis();
      const double pitch = std::abs(x.coordinate(column + 1) - x.coordinate(column));
      result[static_cast<std::size_t>(buffer.sample(column, row))] =
          !(greatest - least <= steepestCell * pitch); // also of infinity less infinity
    }
  return result;
}

/// The samples around a cell and those around them: four by four.
template <typename Visitor>
void visitAround(const DepthBuffer& buffer, std::int64_t column, std::int64_t row,
                 const Visitor& visit) {
  for (std::int64_t r = std::max<std::int64_t>(row, 1) - 1;
       r <= std::min(row + 2, buffer.rows() - 1); ++r)
    for (std::int64_t c = std::max<std::int64_t>(column, 1) - 1;
         c <= std::min(column + 2, buffer.columns() - 1); ++c)
      visit(buffer.sample(c, r));
}

/// Questions that are looked at together.
struct Batch {
  std::size_t size = 0;
  std::array<Seams::Question*, Seams::mostQuestions> question;
  std::array<Glance, Seams::mostQuestions> glance;
  std::array<Sight, Seams::mostQuestions> sight;

  void add(Seams::Question& asked, const Interval& depths) {
    question[size] = &asked;
    glance[size++] = {asked.position, depths};
  }
  std::span<const Glance> glances() const { return std::span(glance).first(size); }
  std::span<Sight> sights() { return std::span(sight).first(size); }
};

} // namespace

Seams::Seams(std::shared_ptr<const FocusTracer> tracer, const FocusDepth& focus)
    : m_tracer(std::move(tracer)), m_reference(focus.depth.reference()) {
  const std::vector<Interval> reaches =
      focusReaches(m_tracer->camera(), focus.depth, m_tracer->cells(), uncertainCells(focus));
  for (const Interval& reach : reaches) {
    m_numbers.push_back(reach.empty() ? -1 : static_cast<std::int32_t>(m_reaches.size()));
    if (reach.empty())
      continue;
    m_reaches.push_back({static_cast<float>(reach.begin - m_reference),
                         static_cast<float>(reach.end - m_reference)});
    m_ends.push_back(reach.end);
  }
  findRim(focus);
  limitReaches(focus);
}

void Seams::findRim(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  std::vector<Glance> glances;
  for (std::int64_t row = 0; row < buffer.rows(); ++row)
    for (std::int64_t column = 0; column < buffer.columns(); ++column) {
      const std::int64_t sample = buffer.sample(column, row);
      if (focus.regions[static_cast<std::size_t>(sample)] != Region::context)
        continue;
      Interval depths{infinity, -infinity};
      for (const std::int64_t r : {std::max<std::int64_t>(row, 1) - 1, row})
        for (const std::int64_t c : {std::max<std::int64_t>(column, 1) - 1, column})
          if (const auto seam = m_numbers[static_cast<std::size_t>(buffer.sample(c, r))];
              seam >= 0) {
            const auto& [least, greatest] = m_reaches[static_cast<std::size_t>(seam)];
            depths = {std::min(depths.begin, m_reference + least),
                      std::max(depths.end, m_reference + greatest)};
          }
      if (depths.empty())
        continue;
      m_rim.push_back({sample, 0.0});
      glances.push_back({buffer.position(column, row), depths});
    }
  std::vector<Sight> sights(glances.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, glances.size(), 256),
                    [&](const auto& range) {
                      m_tracer->look(std::span(glances).subspan(range.begin(), range.size()),
                                     std::span(sights).subspan(range.begin(), range.size()));
                    });
  std::size_t seen = 0;
  for (std::size_t i = 0; i < m_rim.size(); ++i)
    if (sights[i].indicator > FocusCells::foothill)
      m_rim[seen++] = {m_rim[i].sample, sights[i].depth};
  m_rim.resize(seen);
}

/// Of inner seams, to what the samples around see.
void Seams::limitReaches(const FocusDepth& focus) {
  const DepthBuffer& buffer = focus.depth;
  m_isInner.resize(m_reaches.size());
  for (std::int64_t row = 0; row + 1 < buffer.rows(); ++row)
    for (std::int64_t column = 0; column + 1 < buffer.columns(); ++column) {
      const auto seam = m_numbers[static_cast<std::size_t>(buffer.sample(column, row))];
      if (seam < 0)
        continue;
      double greatest = -infinity, least = infinity;
      visitAround(buffer, column, row,
                  [&](std::int64_t sample) { least = std::min(least, buffer.at(sample)); });
      for (const std::int64_t r : {row, row + 1})
        for (const std::int64_t c : {column, column + 1})
          greatest = std::max(greatest, buffer.at(buffer.sample(c, r)));
      if (greatest == infinity)
        continue;
      m_isInner[static_cast<std::size_t>(seam)] = true;
      m_reaches[static_cast<std::size_t>(seam)] = {static_cast<float>(least - m_reference),
                                                   static_cast<float>(greatest - m_reference)};
    }
}

void Seams::move(double offset) {
  m_offset += offset;
  for (Reach& reach : m_reaches)
    reach = {static_cast<float>(reach.least + offset), static_cast<float>(reach.greatest + offset)};
}

void Seams::answer(std::span<Question> questions) const {
  Batch inner, rest;
  const double toFocus = m_reference - m_offset;
  const auto reachOf = [&](const Question& question) {
    return m_reaches[static_cast<std::size_t>(question.seam)];
  };
  const auto addToRest = [&](Question& question) {
    rest.add(question,
             {toFocus + reachOf(question).least, m_ends[static_cast<std::size_t>(question.seam)]});
  };
  for (Question& question : questions) {
    const auto [least, greatest] = reachOf(question);
    if (m_tracer->isFocus(question.position, toFocus + question.between.begin))
      question.surface = least; // it has been met
    else if (isInner(question.seam))
      inner.add(question,
                {toFocus + least, toFocus + std::min<double>(greatest, question.between.end)});
    else
      addToRest(question);
  }
  m_tracer->meet(inner.glances(), inner.sights());
  for (std::size_t i = 0; i < inner.size; ++i)
    if (inner.sight[i].indicator > 0.0)
      inner.question[i]->surface = inner.sight[i].depth - toFocus;
    else
      addToRest(*inner.question[i]);
  m_tracer->look(rest.glances(), rest.sights());
  for (std::size_t i = 0; i < rest.size; ++i)
    if (const Sight& sight = rest.sight[i]; sight.indicator > FocusCells::foothill) {
      Question& question = *rest.question[i];
      const double depth = std::min<double>(sight.depth - toFocus, reachOf(question).greatest);
      const double share = (sight.indicator - FocusCells::foothill) / (0.5 - FocusCells::foothill);
      question.surface += share * (depth - question.surface);
    }
}

} // namespace fenestra
