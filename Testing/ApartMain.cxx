// main of tests whose readers work in a process of their own (io/Apart.h).

#include "io/Apart.h"

#include <gtest/gtest.h>

int main(int argc, char** argv) {
  fenestra::serveApart(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
