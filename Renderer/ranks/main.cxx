#include "program/Process.h"
#include "ranks/RankCommand.h"

int main(int argc, char** argv) {
  fenestra::runProcess(argc, argv, fenestra::dispatchRank);
}
