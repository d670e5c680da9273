fenestra_test(DomainTests DomainTests.cxx LIBRARIES fenestra_volume LABELS unit)
