// Pinocchio's algorithms behind the calls of the race. One robot at a time.
//
// Pinocchio leaves results in memory of its own; that is what is timed. `results` copies those of the
// last call, as dense rows, so that they can be compared.
#include <pinocchio/fwd.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/centroidal.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea-derivatives.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <memory>
#include <string>

namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Rotation = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct Robot {
    pinocchio::Model model;
    std::unique_ptr<pinocchio::Data> data;
    Vector q, qd, last;
};

Robot robot;

// parent, whether it turns, turn (rows), shift, mass, first moment, inertia about the joint's origin
constexpr int NUMBERS_OF_A_JOINT = 2 + 9 + 3 + 1 + 3 + 9;

void read(const double *q, const double *qd, const double *last) {
    const auto n = robot.model.nv;
    robot.q = Eigen::Map<const Vector>(q, n);
    robot.qd = Eigen::Map<const Vector>(qd, n);
    robot.last = Eigen::Map<const Vector>(last, n);
}

double *copied(const Matrix &matrix, double *to) {
    Eigen::Map<Matrix>(to, matrix.rows(), matrix.cols()) = matrix;
    return to + matrix.size();
}

double *symmetric(const Eigen::MatrixXd &upper, double *to) {
    return copied(Eigen::MatrixXd(upper.selfadjointView<Eigen::Upper>()), to);
}

// The columns m, first moment, Ixx, Iyy, Izz, Ixy, Ixz, Iyz of each joint.
void regressor(double *to) {
    constexpr int order[10] = {0, 1, 2, 3, 4, 6, 9, 5, 7, 8};
    const auto &found = robot.data->jointTorqueRegressor;
    Matrix columns(found.rows(), found.cols());
    for (Eigen::Index column = 0; column < found.cols(); ++column)
        columns.col(column) = found.col(column - column % 10 + order[column % 10]);
    copied(columns, to);
}

} // namespace

extern "C" {

void robot_of(const double *joints, int count, const double *gravity) {
    robot = Robot{};
    robot.model.gravity.linear() = Eigen::Map<const Eigen::Vector3d>(gravity);
    for (int i = 0; i < count; ++i) {
        const double *x = joints + i * NUMBERS_OF_A_JOINT;
        const pinocchio::SE3 place(Eigen::Map<const Rotation>(x + 2),
                                   Eigen::Map<const Eigen::Vector3d>(x + 11));
        const auto parent = static_cast<pinocchio::JointIndex>(x[0] + 1);
        const auto name = std::to_string(i);
        const auto joint =
            x[1] != 0 ? robot.model.addJoint(parent, pinocchio::JointModelRZ(), place, name)
                      : robot.model.addJoint(parent, pinocchio::JointModelPZ(), place, name);
        const double mass = x[14];
        const Eigen::Vector3d moment = Eigen::Map<const Eigen::Vector3d>(x + 15);
        const Eigen::Vector3d center = mass == 0 ? moment : Eigen::Vector3d(moment / mass);
        const Eigen::Matrix3d about_center =
            Eigen::Map<const Rotation>(x + 18) -
            mass * (center.squaredNorm() * Eigen::Matrix3d::Identity() - center * center.transpose());
        robot.model.appendBodyToJoint(joint, pinocchio::Inertia(mass, center, about_center),
                                      pinocchio::SE3::Identity());
    }
    robot.data = std::make_unique<pinocchio::Data>(robot.model);
    robot.q = robot.qd = robot.last = Vector::Zero(robot.model.nv);
}

#define CALL(name, ...)                                                                            \
    void name(double *, const double *q, const double *qd, const double *last) {                  \
        read(q, qd, last);                                                                         \
        auto &m = robot.model;                                                                     \
        auto &d = *robot.data;                                                                     \
        __VA_ARGS__;                                                                               \
    }

CALL(inverse_dynamics, pinocchio::rnea(m, d, robot.q, robot.qd, robot.last))
CALL(mass_matrix, pinocchio::crba(m, d, robot.q, pinocchio::Convention::LOCAL))
CALL(forward_dynamics,
     pinocchio::aba(m, d, robot.q, robot.qd, robot.last, pinocchio::Convention::LOCAL))
CALL(dynamics_terms, pinocchio::crba(m, d, robot.q, pinocchio::Convention::LOCAL);
     pinocchio::computeCoriolisMatrix(m, d, robot.q, robot.qd);
     pinocchio::computeGeneralizedGravity(m, d, robot.q))
CALL(gravity_vector, pinocchio::computeGeneralizedGravity(m, d, robot.q))
CALL(centroidal_momentum_matrix, pinocchio::computeCentroidalMap(m, d, robot.q))
CALL(regressor, pinocchio::computeJointTorqueRegressor(m, d, robot.q, robot.qd, robot.last))
CALL(inverse_dynamics_derivatives,
     pinocchio::computeRNEADerivatives(m, d, robot.q, robot.qd, robot.last))

void results(const char *function, double *to) {
    const auto &d = *robot.data;
    const std::string name = function;
    if (name == "inverse_dynamics") copied(d.tau, to);
    if (name == "mass_matrix") symmetric(d.M, to);
    if (name == "forward_dynamics") copied(d.ddq, to);
    if (name == "dynamics_terms") copied(d.g, copied(d.C, symmetric(d.M, to)));
    if (name == "gravity_vector") copied(d.g, to);
    if (name == "centroidal_momentum_matrix") copied(d.Ag, to);
    if (name == "regressor") regressor(to);
    if (name == "inverse_dynamics_derivatives") copied(d.dtau_dv, copied(d.dtau_dq, to));
}

} // extern "C"
