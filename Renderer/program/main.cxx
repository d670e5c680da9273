#include "program/Commands.h"
#include "program/Process.h"

int main(int argc, char** argv) {
  fenestra::core::runProcess(argc, argv, fenestra::core::dispatch);
}
