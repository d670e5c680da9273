#include "clipping/Seams.h"

#include "clipping/FocusCells.h"
#include "clipping/Footprints.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>

namespace fenestra {

namespace {

/// Calls back with each cell between samples, told by its first one, and whether all four samples
/// around it are focus.
template <typename Visitor>
void visitCells(const FocusDepth& focus, const Visitor& visit) {
  const DepthBuffer& buffer = focus.depth;
  for (std::int64_t row = 0; row + 1 < buffer.rows(); ++row)
    for (std::int64_t column = 0; column + 1 < buffer.columns(); ++column)
      visit(column, row,
            focus.isFocus(column, row) && focus.isFocus(column + 1, row) &&
                focus.isFocus(column, row + 1) && focus.isFocus(column + 1, row + 1));
}

/// Of each cell, told by its first sample, whether the focus may end in it.
std::vector<std::uint8_t> outerCells(const FocusDepth& focus) {
  std::vector<std::uint8_t> result(focus.regions.size(), 0);
  visitCells(focus, [&](std::int64_t column, std::int64_t row, bool isInner) {
    result[static_cast<std::size_t>(focus.depth.sample(column, row))] = isInner ? 0 : 1;
  });
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

/// What the samples around a cell see, as deep again as they are apart: a hole between them may
/// reach a little farther.
Interval sightAround(const DepthBuffer& buffer, std::int64_t column, std::int64_t row) {
  Interval depths{infinity, -infinity};
  visitAround(buffer, column, row, [&](std::int64_t sample) {
    if (const double depth = buffer.at(sample); depth < infinity) // not beside the focus
      depths = {std::min(depths.begin, depth), std::max(depths.end, depth)};
  });
  return {depths.begin, 2.0 * depths.end - depths.begin};
}

} // namespace

Seams::Seams(std::shared_ptr<const FocusTracer> tracer, const FocusDepth& focus)
    : m_tracer(std::move(tracer)),
      m_reference(focus.depth.reference()),
      m_numbers(focus.regions.size(), -1) {
  const std::vector<Interval> outer =
      focusReaches(m_tracer->camera(), focus.depth, m_tracer->cells(), outerCells(focus));
  visitCells(focus, [&](std::int64_t column, std::int64_t row, bool isInner) {
    const auto cell = static_cast<std::size_t>(focus.depth.sample(column, row));
    const Interval reach = isInner ? sightAround(focus.depth, column, row) : outer[cell];
    if (reach.empty())
      return;
    m_numbers[cell] = static_cast<std::int32_t>(m_reaches.size());
    m_reaches.push_back({static_cast<float>(reach.begin - m_reference),
                         static_cast<float>(reach.end - m_reference)});
    m_isInner.push_back(isInner);
  });
  findRim(focus);
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

void Seams::move(double offset) {
  m_offset += offset;
  for (Reach& reach : m_reaches)
    reach = {static_cast<float>(reach.least + offset), static_cast<float>(reach.greatest + offset)};
}

void Seams::answer(std::span<Question> questions) const {
  Batch inner, rest;
  const double toFocus = m_reference - m_offset;
  const auto reachOf = [&](const Question& question) {
    const auto& [least, greatest] = m_reaches[static_cast<std::size_t>(question.seam)];
    return Interval{toFocus + least, toFocus + greatest};
  };
  const auto addToRest = [&](Question& question) {
    const Interval reach = reachOf(question);
    rest.add(question, {reach.begin, isInner(question.seam) ? infinity : reach.end});
  };
  for (Question& question : questions) {
    const Interval reach = reachOf(question);
    if (m_tracer->isFocus(question.position, toFocus + question.from))
      question.surface = reach.begin - toFocus; // it has been met
    else if (isInner(question.seam))
      inner.add(question, reach);
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
      const double depth = std::min(sight.depth, reachOf(question).end) - toFocus;
      const double share = (sight.indicator - FocusCells::foothill) / (0.5 - FocusCells::foothill);
      question.surface += share * (depth - question.surface);
    }
}

} // namespace fenestra
