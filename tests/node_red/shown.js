// SPDX-License-Identifier: Apache-2.0
// What a flow's debug nodes show, one line of JSON each, as Node-RED's own editor hears it: node shown.js PORT
"use strict";
const WebSocket = require(`${process.env.AXISGATE_NODE_RED}/node_modules/ws`);
const socket = new WebSocket(`ws://127.0.0.1:${process.argv[2]}/comms`);
socket.on("open", () => {
  socket.send(JSON.stringify({subscribe: "debug"}));
  console.log("subscribed");
});
socket.on("message", (text) => {
  for (const {topic, data} of [JSON.parse(text)].flat()) {
    if (topic === "debug") console.log(JSON.stringify({name: data.name, msg: data.msg, format: data.format}));
  }
});
socket.on("close", () => process.exit(0));
socket.on("error", (error) => {
  console.error(error.message);
  process.exit(1);
});
