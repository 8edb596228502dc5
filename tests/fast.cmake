# What ctest reads when it knows all names: label `fast` for the tests that scripts/test --fast runs, two minutes of two
# cores. All are fast but those that match here; each takes more than about two seconds of processor, waits as long, or
# is one of many alike.
set(slow
  # identification: fits of whole records; of the campaign's seeds one per finding is fast, below
  "^(Identification|TimeDomain|LostRows)Property\\."
  "^Identification\\.(AModeThat|OfANamed|Rounded|AHand|ARounding|ARight|AnInertia|ADelay|AStructure|AReversed|TheBasis|AFit)"
  "^Identification\\.(Counts|AnExtrapolated)"
  "^HiddenFriction\\.Of"
  "^(RingingMode|DoubtedRecording|IdentifiedPeriods|Agreement)\\."
  "^SuspectedMotions\\.(ASpring|ClocksThatRunApartAreADelay|Without|OfANamed|AFrameThatShakesIsSeen)"
  "^PooledResponse\\.(Identifies|Intervals|TwoRecordings|ASine)"
  "^LightMode\\."
  "^WeakDefects\\.(Drag|WithoutThem|AResonance|ACoarse)"
  "^RigidBodyIdentification\\.(ALimit|AMode|ADelay)"
  "^RecordFit\\.(Intervals|WhatDies)"
  "^Nonlinearity\\.(ALinear|DragThat|ASaturated)"
  "^SeveralRates\\.(Identify|Twice)"
  "^GivenNumber\\.(ASpring|That|Friction)"
  "^FewLines\\."
  "^ResponseFriction\\.(NoStiffness|ALinear)"
  "^MeasuredStiffness\\.Distortions"
  "^TimeDomain\\.OfNoise"
  "^InverseDynamics\\.Intervals"
  "^OpenInterval\\.WhereThere"
  # the library
  "^AlikeBranches\\.(Nearly|Six)"
  "^Analysis\\.MarginsThatPolesCrowdAround"
  "^AnyUserLimit\\.IsNeverAboveTheFreeDeviceAtRandom"
  "^AnyUserScan\\."
  "^AnyUserProperty\\.NoSpringOrMassBeats"
  "^HybridLoopProperty\\."
  "^RegionContours\\.(Are|Lie)"
  "^WorstDevice\\.IsNoBetter"
  "^RareFailures\\.AreFoundWhereTheyAreWide"
  "^WallRecommendation\\.OfAnUncertain"
  "^ParameterSweep\\.LimitsDoNotDepend"
  "^DesignTarget\\.EveryNeededValue"
  "^(DesignTarget|DesignComparison|NotchDesign)Property\\."
  "^SensitivityProperty\\.Of"
  "^WallRecommendationProperty\\.RandomDevicesKeepTheMargins"
  "^SafeWall\\.TakesTheLowerEnd"
  # the fronts
  "^LongWorkOnTenBodies\\."
  "together$"
  "^Frame\\.EveryHelp"
  "^Figures\\.Reproduce"
  "^GeneratedFiles\\.(ManualPages|TextIsAscii|HelpIsAsWide)"
  "^Hostile\\.SlowClients"
  "^Study\\.(GoesOn|ComputesAgain|IsTheSameForAnyNumberOfRanks|SaysWhichWalls)"
  "^ServedDocuments\\.(AreThose|Progress)"
  "^Serve\\.WorkOfEveryKind"
  "^Identify\\.(WhatTheData|FindsTheCable|FitsTheMotor)"
  "^SameAnswerOfRecordings\\."
  "^Commands/SameAnswerOn\\.EveryDeviceFile"
  "^Commands/SameAnswerOnRecordings\\..*/(Rigid|LinkOfTwoBodies|InTime)$"
  "^Devices/Export\\.RunsIn.*/(.*_delay|damper|filters|one_filter|lag|transfer_function)$"
  # the loop in real time, which waits; of the drives one, of the devices on the bench three
  "^Rig\\.(EveryAction|Identify|TheReport|TheFlight|TheKnock|TheDefault|ATerminal|TellsWhatItCannotDo)"
  "^RigFault\\."
  "^UdpDriver\\..*OverTheLink"
  "^UnsafeLimit\\.IsNoFalseAlarm"
  "^(Drive/OnDrive|Drive/FrictionOnDrive|Serial/DriveFault)\\..*/(moteus|vesc|simplefoc)$"
  "^Bench/OnDevice\\..*/([3-9]|1[0-9])$"
  "^Bench/IdentifiedDevice\\.")
set(one_per_finding ASofterCrossoverAboveTheBand_1000299 WhatWasNarrowedStaysOpenAboveTheBand_2000606
  AWideIntervalOfLinesElsewhere_2400743 ALackingBodyAboveTheBand_3400146 ResidualsBeyondTheNoise_500431
  FrictionThatShows_500003)
list(JOIN one_per_finding "|" one_per_finding)
get_cmake_property(lists VARIABLES)
list(FILTER lists INCLUDE REGEX "_tests_TESTS$")  # what gtest_discover_tests leaves of each room
foreach(tests IN LISTS lists)
  string(REPLACE _tests_TESTS "" room ${tests})
  set(seeds ${${tests}})
  set(fast ${${tests}})
  list(FILTER seeds INCLUDE REGEX "^Campaign/IdentifiedSeedProperty\\..*/(${one_per_finding})$")
  list(FILTER fast EXCLUDE REGEX "^Campaign/")
  foreach(pattern IN LISTS slow)
    list(FILTER fast EXCLUDE REGEX ${pattern})
  endforeach()
  foreach(test IN LISTS fast seeds)
    set_tests_properties(${test} PROPERTIES LABELS "${room};fast")
  endforeach()
endforeach()
