#include "program/Process.h"
#include "ranks/RankCommand.h"

int main(int argc, char** argv) {
  fenestra::core::runProcess(argc, argv, fenestra::core::dispatchRank);
}
