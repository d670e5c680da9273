#include "program/Commands.h"
#include "program/Process.h"

int main(int argc, char** argv) {
  fenestra::runProcess(argc, argv, fenestra::dispatch);
}
