// Pinocchio's inverse dynamics in a loop over samples, of a robot whose joints all turn about z.
#include <pinocchio/fwd.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <chrono>
#include <string>

using Vector = Eigen::VectorXd;
using Rows3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// placements: rotation by rows, then translation; inertias: mass, centre, inertia about it by rows.
// Answers the seconds that the loop took.
extern "C" double inverse_dynamics(const double *placements, const double *inertias,
                                   const double *gravity, int joints, const double *q,
                                   const double *qd, const double *qdd, double *tau, long samples) {
    pinocchio::Model model;
    pinocchio::JointIndex parent = 0;
    for (int k = 0; k < joints; ++k) {
        const double *place = placements + 12 * k, *body = inertias + 13 * k;
        const pinocchio::SE3 placement(Rows3(Eigen::Map<const Rows3>(place)),
                                       Eigen::Map<const Eigen::Vector3d>(place + 9));
        parent = model.addJoint(parent, pinocchio::JointModelRZ(), placement,
                                "joint" + std::to_string(k));
        const pinocchio::Inertia inertia(body[0], Eigen::Map<const Eigen::Vector3d>(body + 1),
                                         Rows3(Eigen::Map<const Rows3>(body + 4)));
        model.appendBodyToJoint(parent, inertia, pinocchio::SE3::Identity());
    }
    model.gravity.linear() = Eigen::Map<const Eigen::Vector3d>(gravity);
    pinocchio::Data data(model);
    const auto started = std::chrono::steady_clock::now();
    for (long sample = 0; sample < samples; ++sample) {
        const auto of = [&](const double *all) {
            return Eigen::Map<const Vector>(all + sample * joints, joints);
        };
        Eigen::Map<Vector>(tau + sample * joints, joints) =
            pinocchio::rnea(model, data, of(q), of(qd), of(qdd));
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
}
