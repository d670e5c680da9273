#include "program/Commands.h"

#include "program/RenderFlags.h"
#include "program/StudyTable.h"
#include "program/TurntableFrames.h"

namespace fenestra {
namespace {

constexpr Command subcommands[] = {
    {[]() -> const CommandSyntax& { return renderSyntax; }, renderCommand},
    {inspectSyntax, inspectCommand},
    {turntableSyntax, turntableCommand},
    {studySyntax, studyCommand},
    {mergeSyntax, mergeCommand},
    {serveSyntax, serveCommand},
    {compareSyntax, compareCommand},
    {phantomSyntax, phantomCommand},
    {describeSyntax, describeCommand},
};

} // namespace

std::span<const Command> commands() {
  return subcommands;
}

} // namespace fenestra
