"""A small ElastoDyn input of OpenFAST 5, of a made-up turbine."""

TEXT = """\
------- ELASTODYN INPUT FILE ----------------------------------------
A small made-up turbine of three blades; values that are not named are zero or off
---------------------- SIMULATION CONTROL ----------------------------
      False   Echo
          3   Method
  "DEFAULT"   DT
---------------------- DEGREES OF FREEDOM ----------------------------
       True   FlapDOF1
       True   FlapDOF2
       True   EdgeDOF
      False   PitchDOF
      False   TeetDOF
       True   DrTrDOF     - Drivetrain rotational-flexibility DOF (flag)
       True   GenDOF
      False   YawDOF
       True   TwFADOF1
       True   TwFADOF2
       True   TwSSDOF1
       True   TwSSDOF2
      False   PtfmSgDOF
      False   PtfmSwDOF
      False   PtfmHvDOF
      False   PtfmRDOF
      False   PtfmPDOF
      False   PtfmYDOF
---------------------- INITIAL CONDITIONS ----------------------------
          0   OoPDefl
          0   IPDefl
        0.5   BlPitch(1)
        0.5   BlPitch(2)
        0.5   BlPitch(3)
          0   TeetDefl
          0   Azimuth
        9.6   RotSpeed
          0   NacYaw
          0   TTDspFA
          0   TTDspSS
          0   PtfmSurge
          0   PtfmSway
          0   PtfmHeave
          0   PtfmRoll
          0   PtfmPitch
          0   PtfmYaw
---------------------- TURBINE CONFIGURATION -------------------------
          3   NumBl
         50   TipRad
        1.5   HubRad
       -2.5   PreCone(1)
       -2.5   PreCone(2)
       -2.5   PreCone(3)
          0   HubCM
          0   UndSling
          0   Delta3
          0   AzimB1Up
      -4.25   OverHang
       1.75   ShftGagL
         -5   ShftTilt
        1.5   NacCMxn
          0   NacCMyn
      1.625   NacCMzn
         -3   NcIMUxn
          0   NcIMUyn
        2.2   NcIMUzn
        1.9   Twr2Shft
         80   TowerHt
          0   TowerBsHt
          0   PtfmCMxt
          0   PtfmCMyt
          0   PtfmCMzt
          0   PtfmRefxt
          0   PtfmRefyt
          0   PtfmRefzt
---------------------- MASS AND INERTIA ------------------------------
          0   TipMass(1)
          0   TipMass(2)
          0   TipMass(3)
          0   PBrIner(1)
          0   PBrIner(2)
          0   PBrIner(3)
          0   BlPIner(1)
          0   BlPIner(2)
          0   BlPIner(3)
      30000   HubMass
      60000   HubIner     - Hub inertia about rotor axis (kg m^2)
          0   HubIner_Teeter
     200.25   GenIner     - Generator inertia about HSS (kg m^2)
     120000   NacMass
   1.25E+06   NacYIner
          0   YawBrMass
          0   PtfmMass
          0   PtfmRIner
          0   PtfmPIner
          0   PtfmYIner
          0   PtfmXYIner
          0   PtfmYZIner
          0   PtfmXZIner
---------------------- BLADE -----------------------------------------
         17   BldNodes
"blade.dat"   BldFile(1)
"blade.dat"   BldFile(2)
"blade.dat"   BldFile(3)
---------------------- ROTOR-TEETER ----------------------------------
          0   TeetMod
          0   TeetDmpP
          0   TeetDmp
          0   TeetCDmp
          0   TeetSStP
          0   TeetHStP
          0   TeetSSSp
          0   TeetHSSp
---------------------- YAW-FRICTION ----------------------------------
          0   YawFrctMod
        300   M_CSmax
          0   M_FCSmax
          0   M_MCSmax
         40   M_CD
          0   M_FCD
          0   M_MCD
          0   sig_v
          0   sig_v2
          0   OmgCut
---------------------- DRIVETRAIN ------------------------------------
        100   GBoxEff
         80   GBRatio     - Gearbox ratio (-)
    5.5E+08   DTTorSpr    - Drivetrain torsional spring (N-m/rad)
    2.5E+06   DTTorDmp    - Drivetrain torsional damper (N-m/(rad/s))
---------------------- FURLING ---------------------------------------
      False   Furling
   "unused"   FurlFile
---------------------- TOWER -----------------------------------------
         20   TwrNodes
"tower.dat"   TwrFile
---------------------- OUTPUT ----------------------------------------
      False   SumPrint
          1   OutFile
       True   TabDelim
 "ES10.3E2"   OutFmt
          0   TStart
          1   DecFact
          1   NTwGages
         10   TwrGagNd
          3   NBlGages
     5,9,13   BldGagNd
              OutList     - The next lines name the output channels
"RotTorq, LSSTipMxa"      - Torque of the low-speed shaft
"RotSpeed, GenSpeed"      - Speeds of both shafts
END of the list
----------------------------------------------------------------------
"""
