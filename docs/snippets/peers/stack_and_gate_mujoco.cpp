// The loop of MuJoCo. Its argument is the path of stack_and_gate.xml, the model beside this file.
// prints: top at 4\.4[0-9]+ m, gate at 1\.2[0-9]+ rad
#include <mujoco/mujoco.h>

#include <cstdio>

int main(int, char** argv) {
  char error[500];
  mjModel* model = mj_loadXML(argv[1], nullptr, error, sizeof error);
  if (!model) return std::puts(error), 1;
  mjData* data = mj_makeData(model);

  data->ctrl[0] = 1;  // rad/s
  for (int i = 0; i < 1000; ++i) mj_step(model, data);
  const int top = mj_name2id(model, mjOBJ_BODY, "top"), hinge = mj_name2id(model, mjOBJ_JOINT, "hinge");
  std::printf("top at %.3f m, gate at %.3f rad\n", data->xpos[3 * top + 2],
              data->qpos[model->jnt_qposadr[hinge]]);

  mj_deleteData(data);
  mj_deleteModel(model);
}
