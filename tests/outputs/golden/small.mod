! Geometric, not timed: lines and arcs at the controller's own speeds, light by path. Never run on a controller.
! hook.traj (sha256 38c070ade742feb9), as dqpaint 0.1.0 ran it on viper850, plant ideal, law hinf.
! Simulated, and found within the arm's limits of position, speed and torque.
! Nothing here looks after people or machines: clear the space, and watch the first run slowly.
! 2 moves, 1 of them arcs; curves are lines within 0.1 mm. Where the controller slows down the line is brighter.
! Begin near the first pose, in this posture of viper850 [deg]: -1.790, -57.241, 187.328, -2.778, -40.121, 92.125; the zeros and signs of your arm's axes may differ.
! RAPID: the light is on the analog outputs aoRed, aoGreen, aoBlue, 0 to 1; they must exist.
! lamp is the light on the link flange; its flange may be turned on your arm, and its mass is a guess.
MODULE dqpaint_hook
  PERS tooldata lamp:=[TRUE,[[0.00000,0.00000,80.00000],[1.000000000,0.000000000,0.000000000,0.000000000]],[0.5,[0,0,50],[1,0,0,0],0,0,0]];
  CONST zonedata near:=[FALSE,0.1,0.1,0.1,0.1,0.1,0.1];
  VAR triggdata tRed;
  VAR triggdata tGreen;
  VAR triggdata tBlue;
  PROC main()
    ConfL\Off;
    SetAO aoRed,0.00000;
    SetAO aoGreen,0.00000;
    SetAO aoBlue,0.00000;
    MoveL [[800.00000,-20.00000,450.00000],[0.500000000,0.500000000,0.500000000,0.500000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v50,fine,lamp\WObj:=wobj0;
    TriggIO tRed,0\Start\AOp:=aoRed,1.00000;
    TriggIO tGreen,0\Start\AOp:=aoGreen,0.00000;
    TriggIO tBlue,0\Start\AOp:=aoBlue,0.00000;
    TriggL [[800.00000,20.00000,450.00000],[0.500000000,0.500000000,0.500000000,0.500000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[74.9200,1.0000,1000,1000],tRed\T2:=tGreen\T3:=tBlue,fine,lamp\WObj:=wobj0;
    TriggIO tRed,0\Start\AOp:=aoRed,0.50000;
    TriggIO tGreen,0\Start\AOp:=aoGreen,0.50000;
    TriggIO tBlue,0\Start\AOp:=aoBlue,0.50000;
    TriggC [[800.00000,34.14214,455.85786],[0.500000000,0.500000000,0.500000000,0.500000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[[800.00000,40.00000,470.00000],[0.500000000,0.500000000,0.500000000,0.500000000],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]],[58.8336,1.0000,1000,1000],tRed\T2:=tGreen\T3:=tBlue,fine,lamp\WObj:=wobj0;
    SetAO aoRed,0.00000;
    SetAO aoGreen,0.00000;
    SetAO aoBlue,0.00000;
  ENDPROC
ENDMODULE
