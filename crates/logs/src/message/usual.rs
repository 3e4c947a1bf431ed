//! Definitions of the messages that are written here, and that files may leave out.

/// The line between kinds.
macro_rules! rule {
    () => {
        "================================================================================\n"
    };
}

/// The header of messages and its time.
macro_rules! header {
    () => {
        concat!(
            rule!(),
            "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n",
            rule!(),
            "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n",
        )
    };
}

/// A point of a trajectory of joints.
macro_rules! point {
    () => {
        concat!(
            "MSG: trajectory_msgs/JointTrajectoryPoint\n",
            "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\n",
            "float64[] effort\nbuiltin_interfaces/Duration time_from_start\n",
            rule!(),
            "MSG: builtin_interfaces/Duration\nint32 sec\nuint32 nanosec\n",
        )
    };
}

/// A point of a trajectory of bodies.
macro_rules! several {
    () => {
        concat!(
            "MSG: trajectory_msgs/MultiDOFJointTrajectoryPoint\n",
            "geometry_msgs/Transform[] transforms\n",
            "geometry_msgs/Twist[] velocities\n",
            "geometry_msgs/Twist[] accelerations\n",
            "builtin_interfaces/Duration time_from_start\n",
            rule!(),
            "MSG: geometry_msgs/Transform\nVector3 translation\nQuaternion rotation\n",
            rule!(),
            "MSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n",
            rule!(),
            "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
            rule!(),
            "MSG: geometry_msgs/Quaternion\n",
            "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n",
        )
    };
}

/// A kind and its definition.
pub(crate) struct Usual {
    pub(crate) kind: &'static str,
    /// The newest first.
    pub(crate) definitions: &'static [&'static str],
}

/// Positions, velocities and efforts of joints.
pub(crate) const JOINT_STATE: Usual = Usual {
    kind: "sensor_msgs/msg/JointState",
    definitions: &[concat!(
        "std_msgs/Header header\n",
        "string[] name\n",
        "float64[] position\n",
        "float64[] velocity\n",
        "float64[] effort\n",
        header!(),
    )],
};

/// A force and a moment.
pub(crate) const WRENCH: Usual = Usual {
    kind: "geometry_msgs/msg/WrenchStamped",
    definitions: &[concat!(
        "std_msgs/Header header\n",
        "Wrench wrench\n",
        header!(),
        rule!(),
        "MSG: geometry_msgs/Wrench\nVector3 force\nVector3 torque\n",
        rule!(),
        "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n",
    )],
};

/// A number.
pub(crate) const NUMBER: Usual =
    Usual { kind: "std_msgs/msg/Float64", definitions: &["float64 data\n"] };

/// What a controller of joints wants and gets.
pub(crate) const CONTROLLER_STATE: Usual = Usual {
    kind: "control_msgs/msg/JointTrajectoryControllerState",
    definitions: &[
        concat!(
            "std_msgs/Header header\n",
            "string[] joint_names\n",
            "trajectory_msgs/JointTrajectoryPoint reference\n",
            "trajectory_msgs/JointTrajectoryPoint feedback\n",
            "trajectory_msgs/JointTrajectoryPoint error\n",
            "trajectory_msgs/JointTrajectoryPoint output\n",
            "string[] multi_dof_joint_names\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_reference\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_feedback\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_error\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_output\n",
            header!(),
            rule!(),
            point!(),
            rule!(),
            several!(),
        ),
        // with both old and new names
        concat!(
            "std_msgs/Header header\n",
            "string[] joint_names\n",
            "trajectory_msgs/JointTrajectoryPoint reference\n",
            "trajectory_msgs/JointTrajectoryPoint feedback\n",
            "trajectory_msgs/JointTrajectoryPoint error\n",
            "trajectory_msgs/JointTrajectoryPoint output\n",
            "trajectory_msgs/JointTrajectoryPoint desired\n",
            "trajectory_msgs/JointTrajectoryPoint actual\n",
            "string[] multi_dof_joint_names\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_reference\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_feedback\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_error\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_output\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_desired\n",
            "trajectory_msgs/MultiDOFJointTrajectoryPoint multi_dof_actual\n",
            header!(),
            rule!(),
            point!(),
            rule!(),
            several!(),
        ),
        concat!(
            "std_msgs/Header header\n",
            "string[] joint_names\n",
            "trajectory_msgs/JointTrajectoryPoint desired\n",
            "trajectory_msgs/JointTrajectoryPoint actual\n",
            "trajectory_msgs/JointTrajectoryPoint error\n",
            header!(),
            rule!(),
            point!(),
        ),
    ],
};

/// The usual definitions of a kind, the newest first; none if it is not known.
pub(crate) fn usual(kind: &str) -> &'static [&'static str] {
    let all = [JOINT_STATE, WRENCH, NUMBER, CONTROLLER_STATE];
    let same = |one: &Usual| super::short_kind(one.kind) == super::short_kind(kind);
    all.into_iter().find(same).map_or(&[], |one| one.definitions)
}
