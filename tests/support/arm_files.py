"""A small URDF arm for tests: six joints, a gripper, and places where faults can be put."""

ARM = """<robot name="arm">
  <link name="base"/>
  {links}
  <link name="tip"/>
  <link name="finger"><inertial><mass value="0.1"/><inertia ixx="1e-4" ixy="0" ixz="0" iyy="1e-4"
    iyz="0" izz="1e-4"/></inertial></link>
  {joints}
  <joint name="end" type="fixed"><parent link="l6"/><child link="tip"/>
    <origin xyz="0 0 0.05"/></joint>
  <joint name="grip" type="prismatic"><parent link="tip"/><child link="finger"/>
    <limit lower="0" upper="0.1" velocity="1" effort="1"/></joint>
</robot>
"""
PLACES = ((0, 0, 0.3), (0, 0, 0.1), (0.4, 0, 0), (0, 0, 0.05), (0.35, 0, 0), (0.05, 0, 0))
AXES = ("0 0 1", "0 1 0", "0 1 0", "1 0 0", "0 1 0", "1 0 0")


def arm_urdf(count=6):
    """The text of an arm of so many joints; link i is carried by joint i."""
    links, joints = [], []
    for i in range(1, count + 1):
        parent = "base" if i == 1 else f"l{i - 1}"
        xyz = " ".join(map(str, PLACES[i - 1]))
        links.append(
            f'<link name="l{i}"><inertial><origin xyz="0.05 0 0.02"/><mass value="{7 - i}"/>'
            f'<inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.025"/>'
            "</inertial></link>"
        )
        joints.append(
            f'<joint name="j{i}" type="revolute"><parent link="{parent}"/><child link="l{i}"/>'
            f'<origin xyz="{xyz}" rpy="0 0 0"/><axis xyz="{AXES[i - 1]}"/>'
            f'<limit lower="-2.5" upper="2.{i}" velocity="2" effort="400"/></joint>'
        )
    text = ARM.format(links="\n  ".join(links), joints="\n  ".join(joints))
    return text.replace('"l6"', f'"l{count}"')
