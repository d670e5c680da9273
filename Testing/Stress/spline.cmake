fenestra_test(SurfaceStressTests SurfaceStressTests.cxx LIBRARIES fenestra_clipping LABELS stress)
# The thin plate spline against 50 digits, for which Boost's headers are enough.
find_package(Boost 1.74)
if(Boost_FOUND)
  fenestra_test(SplineStressTests SplineStressTests.cxx
    LIBRARIES fenestra_clipping Boost::headers LABELS stress)
else()
  message(WARNING "SplineStressTests are left out: they need Boost.Multiprecision (libboost-dev)")
endif()
